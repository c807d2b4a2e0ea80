/// Functions that set up a simulated run or evaluate its rows. Private to this folder.
#pragma once

#include <cstddef>

#include "awmr/simulate/run_controller.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// Speed |u|, m/s, below which a vehicle counts as stopped. If no way to the target is left between
/// obstacles, the run of a stopped vehicle ends with RunEnd::kNoPassage.
inline constexpr double kStopped_mps = 1e-3;

/// Returns the controller with the settings that the scenario requests: form of the allocation, and
/// split of the yaw moment in combined mode.
Controller<double> controller_in(const Scenario& scenario, Controller<double> controller);

/// Returns the controller properties that all runs of a scenario share, from the `controller` of
/// any run. is_observed stays false, because it depends on the gains of each run.
ControllerSetup controller_setup(const Scenario& scenario, const Controller<double>& controller,
                                 double sample_time_s);

/// Returns the controller of a run in this yaw mode. `controller`: the result of controller_in().
RunController<double> run_controller(const Scenario& scenario, const Controller<double>& controller,
                                     YawMode mode);

/// Largest motor command divided by F_max: F'max plus the dead zone.
double largest_force(const Controller<double>& controller);

/// Distance from the vehicle to the nearest obstacle, m; < 0 if they overlap. The vehicle is a
/// circle with the radius Avoidance::vehicle_radius_m, or a point without avoidance.
double clearance_m(const Scenario& scenario, const State<double>& state);

/// Index, from 0, of the last sample within the duration. Tolerates rounding errors of the
/// duration.
std::size_t samples_in(double duration_s, double sample_time_s);

}  // namespace awmr
