/// Simulation of one run in closed loop. Over each sample, the command of the controller is
/// constant, and the plant is integrated by RK4 steps.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/control/controller.h"
#include "awmr/core/result.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/vehicle.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

struct DrawnNoise;

/// Guidance columns of a row of run.csv, in addition to the vehicle's state; unused in open loop.
struct PathRow {
  double psi_goal_rad = 0.0;    ///< heading of the guidance, before avoidance and shaping
  double cross_track_m = 0.0;   ///< distance from the current leg, line or path, left positive
  Position<double> target_m{};  ///< target point: waypoint, end of the segment, point of the path
  int leg = 0;                  ///< index of the waypoint or segment, from 0
};

/// One row of a run: the state at the time t, and the command computed at t, which is constant
/// until the next row.
struct RunRow {
  double t_s = 0.0;
  State<double> state{};
  SideForces<double> force{};         ///< command of each motor of a side, over F_max
  double steering_command_rad = 0.0;  ///< d_ro: commanded steering angle, rad, left positive
  double tau_speed = 0.0;             ///< output of the speed law minus the estimated disturbance,
                                      ///< before any limit, dimensionless
  double tau_turn_m = 0.0;            ///< like tau_speed, of the heading law: yaw moment, m
  double psi_ref_rad = 0.0;           ///< psi_d: heading reference of the law; 0 in open loop
  double u_ref_mps = 0.0;             ///< u_d: speed reference of the law; 0 in open loop
  PathRow path = {};
  Measurement<double> measured = {};          ///< measurements of the controller
  Position<double> measured_position_m = {};  ///< position that the guidance uses
  BodyLoad disturbance = {};                  ///< external forces, without those of a slope
  /// Distance from the vehicle's circle (a point without avoidance) to the nearest obstacle, m; < 0
  /// if they overlap; 0 without obstacles.
  double clearance_m = 0.0;
  /// Power dissipated by the lateral tyre forces, over F_max, m/s. In the 3-DOF model, it is the
  /// power dissipated by tyre scrub; that of the yaw resistance g3 is not included.
  double tyre_power_mps = 0.0;
  /// Mean wheel forces over the sample that ends at this row, over F_max, after motor lag, battery,
  /// faults and slippery ground; dead zone and back-EMF are not subtracted. 0 in the first row.
  WheelForces<double> acting = {0.0, 0.0, 0.0, 0.0};
};

/// End of a run.
enum class RunEnd {
  kDuration,   ///< the scenario's duration is over
  kFinished,   ///< the last waypoint or the end of the line was reached
  kNoPassage,  ///< obstacles block the way to the guidance target: the vehicle stopped
  /// Failed early, without a valid result (see failure_of): a number was not finite, no step was
  /// short enough for the motion, or the run exceeds kMaxRows or kMaxSteps.
  kFailed,
};

/// One simulated run.
struct Run {
  std::vector<RunRow> rows;  ///< at the times 0, T_s, 2 T_s, ... including the end of the run
  int substeps = 0;          ///< RK4 steps per sample
  RunEnd end = RunEnd::kDuration;
  int missed_waypoints = 0;  ///< including those covered by an obstacle
  int position_resets = 0;   ///< resets of the position estimate after rejected fixes, up to 255
};

/// Options of a run.
struct SimulateOptions {
  /// T_s, s, > 0: time between two commands of the controller.
  double sample_time_s = 0.01;
  /// RK4 steps per sample, > 0, to study the integration error. Absent: substeps_for().
  std::optional<int> substeps;
  /// Seed of all random numbers, together with the scenario's own seed.
  std::uint64_t seed = 0;
  /// Number of the draw (0, 1, 2, ...) for several runs with one seed.
  std::uint64_t sample = 0;
  /// As BatchRun::noise.
  const DrawnNoise* noise = nullptr;
};

/// Limits of a run: rows that take half a gigabyte, and RK4 steps that take about a minute.
inline constexpr double kMaxRows = 2e6;
inline constexpr double kMaxSteps = 1e8;
inline constexpr int kMaxSubsteps = 100'000'000;

/// Number of RK4 steps per sample, in [1, kMaxSubsteps]. They resolve those time constants of the
/// plant that do not depend on speed (step_limit() in physics.h).
int substeps_for(const Plant<double>& plant, double sample_time_s);
/// substeps_for() in a scenario: its tyres, if any, replace the plant's sway and yaw resistance.
int substeps_for(const Plant<double>& plant, const Scenario& scenario, double sample_time_s);

/// A controller with the parameters of this plant, whose resistances it feeds forward, with these
/// gains and the limits of the vehicle. Its friction width in yaw is that of the steering mode;
/// each run sets that of its own mode.
Controller<double> make_controller(const Plant<double>& plant, const Vehicle& vehicle,
                                   const Gains<double>& gains,
                                   CombinedSplit split = CombinedSplit::kRedistribute);

/// A controller with the estimates of the model, whatever corner a scenario has. If the model only
/// has parameters for straight motion, the same holds for the controller. Errors (input): those of
/// Model::plant() and check_observer_rate().
Result<Controller<double>> controller_for(const Model& model, const Gains<double>& gains);

/// Simulates the model with the controller of controller_for(), at the vehicle's sample time. The
/// scenario's corner changes the plant, but not the controller. A model without turning parameters
/// (Model::simulated_motion) can only drive straight. Errors (input): those of plant_for(),
/// Model::plant(), check_mode(), failure_of() and check_straight() (straight.h).
Result<Run> simulate(const Model& model, const Gains<double>& gains, const Scenario& scenario,
                     YawMode mode);

/// Checks the length of a run before it is simulated. Errors (input): the run would have more than
/// kMaxRows rows, or more than kMaxSteps RK4 steps. The message names duration_s, or the parameter
/// whose time constant requires so many steps. `model_file`: name for the message.
Status check_work(const Plant<double>& plant, const std::string& model_file,
                  const Scenario& scenario, double sample_time_s);

/// Errors (input): the run ended as kFailed; the message has the time and the speeds of the last
/// row.
Status failure_of(const Run& run, const Scenario& scenario);

/// Simulates the given plant and controller. The result has at least one row. Its end is
/// RunEnd::kFailed if the run could not continue, or is too long for check_work(). The scenario's
/// corner is not applied; plant_for() gives the plant at the corner.
Run simulate(const Plant<double>& plant, const Controller<double>& controller,
             const Scenario& scenario, YawMode mode, const SimulateOptions& options);

/// Content of run.csv: the columns of every run, then those that this scenario adds.
std::string run_csv(const Run& run, const Scenario& scenario);
/// The values of a row with the names of their columns in run.csv.
std::vector<std::pair<std::string_view, double>> named_values(const RunRow& row,
                                                              const Scenario& scenario);

}  // namespace awmr
