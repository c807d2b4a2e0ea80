/// The closed loop: RK4 on the 3-DOF plant between samples, the controller's command held over each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/control/controller.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/vehicle.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// The state at t and the command computed from it, held until the next row.
struct RunRow {
  double t_s = 0.0;
  State<double> state{};
  SideForces<double> force{};
  double steering_command_rad = 0.0;
  double tau_speed = 0.0;   ///< asked for by the law, before any limit
  double tau_turn_m = 0.0;  ///< asked for by the law, before any limit
  double psi_ref_rad = 0.0;  ///< 0 in open loop
  double u_ref_mps = 0.0;    ///< 0 in open loop
};

struct Run {
  std::vector<RunRow> rows;  ///< at 0, T_s, 2 T_s, ... up to and including duration_s
  int substeps = 0;          ///< RK4 steps per sample
};

struct SimulateOptions {
  double sample_time_s = 0.01;      ///< T_s, > 0
  std::optional<int> substeps;      ///< RK4 steps per sample; absent: substeps_for()
};

/// Steps per sample such that the step resolves the fastest time constant of the plant: see the .cpp.
int substeps_for(const Plant<double>& plant, double sample_time_s);

/// The plant's controller with these gains and the vehicle's limits.
Controller<double> make_controller(const Plant<double>& plant, const Vehicle& vehicle,
                                   const Gains<double>& gains,
                                   CombinedSplit split = CombinedSplit::kRedistribute);

/// Never fails on a valid plant, controller and scenario; all rows are finite.
Run simulate(const Plant<double>& plant, const Controller<double>& controller,
             const Scenario& scenario, YawMode mode, const SimulateOptions& options);

/// The bytes of run.csv, contract columns.
std::string run_csv(const Run& run);

}  // namespace awmr
