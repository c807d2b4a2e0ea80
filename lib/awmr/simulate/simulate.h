/// Simulation of one run in closed loop. Over each sample, the commands of the controller are
/// constant, and RK4 steps integrate the plant.
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

/// Guidance columns of a row of run.csv, in addition to the vehicle's state. Not used in open loop.
struct PathRow {
  double psi_goal_rad = 0.0;   ///< desired heading of the guidance, before avoidance and shaping
  double cross_track_m = 0.0;  ///< distance from the current leg, line or path, left positive
  /// target point: waypoint, end of the segment, or point of the timed path
  Position<double> target_m{};
  int leg = 0;  ///< index of the current waypoint or segment, from 0
};

/// One row of a run: the state at the time t, and the command computed at t. The command is
/// constant until the next row.
struct RunRow {
  double t_s = 0.0;
  State<double> state{};
  SideForces<double> force{};         ///< command of each motor, left and right, divided by F_max
  double steering_command_rad = 0.0;  ///< d_ro: commanded steering angle, rad, left positive
  /// Requested surge force, before any limit: output of the speed law minus the estimated
  /// disturbance. The force is divided by F_max, so it is dimensionless.
  double tau_speed = 0.0;
  /// Requested yaw moment, before any limit: output of the heading law minus the estimated
  /// disturbance. The moment is divided by F_max, so its unit is m.
  double tau_turn_m = 0.0;
  double psi_ref_rad = 0.0;  ///< psi_d: desired heading, input of the law; 0 in open loop
  double u_ref_mps = 0.0;    ///< u_d: desired speed, input of the law; 0 in open loop
  PathRow path = {};
  Measurement<double> measured = {};          ///< measurements that the controller gets
  Position<double> measured_position_m = {};  ///< position that the guidance uses
  /// external forces; the force of a slope is not included
  BodyLoad disturbance = {};
  /// Distance from the vehicle to the nearest obstacle, m; < 0 if they overlap; 0 without
  /// obstacles. If the vehicle avoids obstacles, its shape is a circle, else a point.
  double clearance_m = 0.0;
  /// Power divided by F_max, m/s, that the lateral tyre forces dissipate. In the 3-DOF model: the
  /// power of tyre scrub, without the power of the yaw resistance g3.
  double tyre_power_mps = 0.0;
  /// Mean wheel forces divided by F_max, over the sample that ends at this row. Effects of motor
  /// lag, battery, faults and slippery ground are included, dead zone and back-EMF are not. 0 in
  /// the first row.
  WheelForces<double> acting = {0.0, 0.0, 0.0, 0.0};
};

enum class RunEnd {
  kDuration,   ///< the scenario's duration is over
  kFinished,   ///< the vehicle reached the last waypoint or the end of the line
  kNoPassage,  ///< obstacles leave no way to the target, and the vehicle has stopped
  /// The run failed and has no valid result: a number was not finite, no integration step was short
  /// enough for the motion, or the run exceeds kMaxRows or kMaxSteps. failure_of() has the message.
  kFailed,
};

/// One simulated run.
struct Run {
  std::vector<RunRow> rows;  ///< one row at each time 0, T_s, 2 T_s, ... up to the end
  int substeps = 0;          ///< RK4 steps per sample
  RunEnd end = RunEnd::kDuration;
  /// number of missed waypoints, including those that an obstacle covers
  int missed_waypoints = 0;
  /// Number of restarts of the position estimate, after it rejected several GPS fixes in a row; at
  /// most 255.
  int position_resets = 0;
};

/// Options of a run.
struct SimulateOptions {
  /// T_s, s, > 0: time between two commands of the controller.
  double sample_time_s = 0.01;
  /// RK4 steps per sample, > 0; set it only to study the integration error. Absent: the result of
  /// substeps_for().
  std::optional<int> substeps = {};
  /// Seed of the simulation. Together with the scenario's own seed, it determines all random
  /// numbers.
  std::uint64_t seed = 0;
  /// Number of the Monte-Carlo draw (0, 1, 2, ...), which changes the random numbers of a seed.
  std::uint64_t sample = 0;
  /// Sensor noise drawn in advance, or null (BatchRun::noise).
  const DrawnNoise* noise = nullptr;
};

/// Limits of a run, chosen for memory and time: kMaxRows rows take half a gigabyte, and kMaxSteps
/// RK4 steps take about a minute.
inline constexpr double kMaxRows = 2e6;
inline constexpr double kMaxSteps = 1e8;
inline constexpr int kMaxSubsteps = 100'000'000;

/// Returns the number of RK4 steps per sample, in [1, kMaxSubsteps]. They are short enough for
/// those time constants of the plant that do not depend on speed (step_limit() in physics.h). If the
/// scenario has tyres, their forces replace the sway and yaw resistance of the plant.
int substeps_for(const Plant<double>& plant, const Scenario& scenario, double sample_time_s);

/// Makes a controller with these gains, whose model is the plant: it feeds forward the plant's
/// resistances, and has the limits of the vehicle. It gets the friction width in yaw (HeadingGains
/// in model/gains.h) of steering mode; each run replaces it by the width of its own mode.
Controller<double> make_controller(const Plant<double>& plant, const Vehicle& vehicle,
                                   const Gains<double>& gains,
                                   CombinedSplit split = CombinedSplit::kRedistribute);

/// Makes a controller whose model has the estimated parameters, even if a scenario sets parameters
/// of the plant to an end of their interval. If the model has only the parameters of straight
/// motion, the controller can only drive straight. Errors (input): those of Model::plant() and
/// check_observer_rate().
Result<Controller<double>> controller_for(const Model& model, const Gains<double>& gains);

/// Simulates the model with the controller of controller_for(), at the vehicle's sample time. A
/// scenario without sensors or actuators gets the vehicle's (equipped() in conditions.h).
/// Scenario::corner sets plant parameters to an end of their interval; the controller keeps the
/// estimates. A model without turning parameters (Model::simulated_motion()) can only drive
/// straight. Errors (input): those of plant_for(), Model::plant(), check_mode() and failure_of();
/// the run turns or moves sideways, but the model only has parameters for straight motion.
Result<Run> simulate(const Model& model, const Gains<double>& gains, const Scenario& scenario,
                     YawMode mode);

/// Checks the length of a run before it is simulated. Errors (input): the run would have more than
/// kMaxRows rows, or more than kMaxSteps RK4 steps. The message names the cause: duration_s, or the
/// parameter with the short time constant. `model_file` is the model file that the message names.
Status check_work(const Plant<double>& plant, const std::string& model_file,
                  const Scenario& scenario, double sample_time_s);

/// Returns the error of a failed run, else success. Errors (input): the run ended as kFailed. The
/// message has the time and the speeds of the last row.
Status failure_of(const Run& run, const Scenario& scenario);

/// Simulates a run with the given plant and controller. Pass the plant that plant_for() returns,
/// because Scenario::corner is not applied here. The result has at least one row. Its end is
/// RunEnd::kFailed if the run could not continue, or is too long for check_work().
Run simulate(const Plant<double>& plant, const Controller<double>& controller,
             const Scenario& scenario, YawMode mode, const SimulateOptions& options);

/// Returns the values of a row, each with the name of its column in run.csv: first the columns that
/// every run has, then those that this scenario adds.
std::vector<std::pair<std::string_view, double>> named_values(const RunRow& row,
                                                              const Scenario& scenario);
/// True if every number of the row is finite.
bool is_finite(const RunRow& row);

/// Distance from the vehicle to the nearest obstacle, m; < 0 if they overlap. The vehicle is a
/// circle with the radius Avoidance::vehicle_radius_m, or a point without avoidance.
double clearance_m(const Scenario& scenario, const State<double>& state);

/// Index, from 0, of the last sample within the duration. Tolerates rounding errors of the
/// duration.
std::size_t samples_in(double duration_s, double sample_time_s);

}  // namespace awmr
