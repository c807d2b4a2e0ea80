/// The vehicle that a log fit simulates in a window and the errors of its sensors, at one point of
/// the search. Private to identify/.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "awmr/identify/logs/problem/channel_noise.h"
#include "awmr/identify/logs/problem/quantities.h"
#include "awmr/identify/logs/simulation/filtered_channel.h"
#include "awmr/identify/logs/simulation/smoothing_kernel.h"
#include "awmr/identify/logs/simulation/wheel_slip.h"

namespace awmr {

/// Vehicle, free quantities and noise of a log fit. All windows share them.
struct LogModel {
  Vehicle vehicle;
  /// Values of the fixed parameters; entries of free ones are not used.
  ParameterValues<double> held;
  std::vector<FreeQuantity> quantities;
  std::vector<InitialComponent> initial;
  NoiseLevels noise;
  double row_spacing_s = 0.02;   ///< shortest row spacing of the logs
  double longest_step_s = 0.01;  ///< longest integration step
};

struct Smoothing {
  SmoothingKernel kernel;
  std::size_t column;   ///< column of the variance of the kernel, s^2
  double rows2_per_s2;  ///< variance of the kernel in rows^2 over that in s^2
};

/// Errors of the sensors (bias, delay, ...) at one point of the search. For each error that the fit
/// estimates, also its column among the unknowns of the fit.
struct SensorTerms {
  std::vector<std::pair<LogChannel, TermColumn>> biases;  ///< a channel's biases add up
  std::array<std::optional<TermColumn>, kChannelCount> delay{};
  std::array<std::optional<TermColumn>, kChannelCount> averaging{};
  std::array<std::optional<SensorFilter>, kChannelCount> lag{};  ///< without their damping
  std::array<std::optional<TermColumn>, kChannelCount> lag_damping{};
  std::array<std::optional<Smoothing>, kChannelCount> smoothing{};
  std::array<std::optional<TermColumn>, kChannelCount> scale{};
  std::vector<WheelSlip> slips;
  TermColumns mounting;  ///< kSwayOffset to kCompassCos2

  /// True if a reading depends on the motion before its row: latency or averaging.
  bool any_earlier() const;
  bool any_smoothed() const;
};

/// Plant, command path, sensor errors and initial state at one point of the search, with the
/// columns of the free quantities.
struct SimulatedVehicle {
  Plant<double> plant;
  std::vector<ParameterColumn> parameters;
  CommandPath path;
  ExtraForces extra;
  SensorTerms sensors;
  /// Columns with equal derivatives: (first, second). Only the first is computed by the simulation.
  std::vector<std::pair<std::size_t, std::size_t>> equal_columns;
  State<double> initial{};
};

/// Returns the simulated vehicle at these coordinates (one per free quantity) and this initial
/// state of a window (one value per free component).
SimulatedVehicle vehicle_at(const LogModel& model, const FitWindow& window,
                            const double* coordinates, const double* initial_state);

/// Initial motion of a window. The derivative of each free component of the state with respect to
/// itself is 1, and so is the derivative of the steering angle with respect to the trim. All other
/// derivatives are 0.
LinearMotion first_motion(const LogModel& model, const SimulatedVehicle& vehicle,
                          std::size_t columns);

}  // namespace awmr
