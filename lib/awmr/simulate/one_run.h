/// Functions that set up the closed loop of a run or evaluate its rows. Private to this folder.
#pragma once

#include <cstddef>

#include "awmr/simulate/run_controller.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/simulate.h"

namespace awmr {

/// If obstacles leave a vehicle no passage, it counts as stopped below this speed |u|, m/s. Its run
/// then ends as RunEnd::kNoPassage.
inline constexpr double kStopped_mps = 1e-3;

/// The controller with the allocation form and the split that the scenario requests.
Controller<double> controller_in(const Scenario& scenario, Controller<double> controller);

/// Properties common to the controllers of all runs of a scenario. `controller`: that of any of the
/// runs. is_observed depends on the gains of each run, so it is left false.
ControllerSetup controller_setup(const Scenario& scenario, const Controller<double>& controller,
                                 double sample_time_s);

/// The controller of a run in this mode. `controller`: the result of controller_in().
RunController<double> run_controller(const Scenario& scenario, const Controller<double>& controller,
                                     YawMode mode);

/// Largest motor command over F_max: F'max plus the dead zone.
double largest_force(const Controller<double>& controller);

/// Distance from the vehicle's circle (radius Avoidance::vehicle_radius_m, 0 without avoidance) to
/// the nearest obstacle, m; < 0 if they overlap.
double clearance_m(const Scenario& scenario, const State<double>& state);

/// True if every number of the row is finite.
bool is_finite(const RunRow& row);

/// Index, from 0, of the last sample within the duration. Tolerates rounding of the duration.
std::size_t samples_in(double duration_s, double sample_time_s);

}  // namespace awmr
