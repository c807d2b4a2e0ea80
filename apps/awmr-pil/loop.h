// Closed loop of the vehicle and the control step. The vehicle is simulated in double, as in
// simulate/; the control step is computed in float by an Executor.
#pragma once

#include <vector>

#include "awmr/core/progress.h"
#include "awmr/emit/board/gps_check.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "executor.h"
#include "pil_options.h"

namespace awmr::pil {

struct LoopSetup {
  Plant<double> plant;
  double sample_time_s = 0.01;
  double force_max = 1.0;  ///< largest force of a wheel that may be commanded, divided by F_max
  Scenario scenario;
  Mission mission;  ///< mission_of() the scenario
  YawMode mode = YawMode::kCombined;
  cli::Injection injection = cli::Injection::kNone;
  SafetyLimits limits{};   ///< limits of the firmware's input checks
  GpsLimits gps_limits{};  ///< limits of the sketches' GPS checks
  std::size_t middle = 0;  ///< number of the first step in which the injection acts
  /// Numbers of the steps before which the executor is reset.
  std::vector<std::size_t> resets = {};
};

struct LoopRow {
  double t_s = 0.0;
  State<double> state{};
  Step step;
  /// Sensor check of the sketches that fails in this step; kSensorGood if none fails.
  SensorFault cause = kSensorGood;
  SideForces<double> force{};         ///< forces that the actuators receive in this step
  double steering_command_rad = 0.0;  ///< steering angle that the servo receives in this step
};

/// Copies noise and latency of the scenario's GPS to the model's vehicle. The Kalman gain of the
/// firmware's position estimate is computed from these numbers, so it equals that of the simulator.
void know_receiver(const Gps& gps, Model& model);

/// True if the speed sensor gives no sign, so that the firmware must find the direction of travel.
bool has_unsigned_speed(const Scenario& scenario);

/// Checks that the firmware can run the scenario. Errors (input): the scenario uses a feature that
/// the firmware does not support, or has more than kMaxPoints points.
Status check_scenario(const Scenario& scenario, const std::string& file);

/// Runs the closed loop until the scenario's duration or its path ends, or obstacles leave no
/// passage. Returns one row per control step. Errors: those of the executor; (input) the simulation
/// diverges.
Result<std::vector<LoopRow>> run_loop(const LoopSetup& setup, Executor& executor,
                                      const Progress& progress = {});

}  // namespace awmr::pil
