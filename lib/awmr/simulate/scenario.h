/// A scenario: the task of the vehicle and its environment. scenario_file.h reads scenarios.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "awmr/control/guidance/heading_shaping.h"
#include "awmr/control/guidance/line_laws.h"
#include "awmr/control/guidance/obstacles.h"
#include "awmr/control/guidance/timed_path.h"
#include "awmr/control/yaw_mode.h"
#include "awmr/core/name_table.h"
#include "awmr/core/result.h"
#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"
#include "awmr/model/state.h"
#include "awmr/model/tyres.h"
#include "awmr/simulate/world.h"

namespace awmr {

/// Open loop: constant thrust and yaw moment, which the allocation converts to commands of the yaw
/// mode, within their limits.
struct OpenLoop {
  double tau_speed = 0.0;   ///< thrust divided by F_max, forward positive
  double tau_turn_m = 0.0;  ///< yaw moment divided by F_max, m, counter-clockwise positive
};

/// A commanded heading, and the time at which the command begins.
struct HeadingStep {
  double t_s = 0.0;      ///< start of the command, s, >= 0
  double psi_rad = 0.0;  ///< heading, counter-clockwise from the world's x axis
};

/// A sequence of commanded headings. Each is held until the next begins. The first begins at t = 0.
struct HeadingSteps {
  std::vector<HeadingStep> steps;  ///< in the order of time, at different times, not empty
  /// Constant thrust tau_speed, dimensionless, forward positive, as in the paper's experiment. It
  /// replaces the speed law, so surge disturbances are not estimated. Absent: the speed law
  /// controls the scenario's speed_mps.
  std::optional<double> tau_speed = {};
};

/// Waypoints. The vehicle heads for the next waypoint (line of sight). The run ends when the last
/// waypoint is reached.
struct WaypointPath {
  std::vector<Position<double>> points_m;  ///< not empty
  double acceptance_m = 0.0;               ///< > 0: a waypoint is reached within this distance
  bool skip_passed = false;                ///< see Waypoints::skip_passed
  /// m, > 0: within this distance of the last point, the reference speed is reduced in proportion
  /// to the distance, but not below a tenth of speed_mps. Absent: the speed is not reduced.
  std::optional<double> slow_down_m;
};

/// A line-following law with its parameters: the paper's line of sight, or another law for
/// comparison.
using AnyLineLaw = LineLaws<std::variant, double>;
/// Returns one object of each law, with all parameters 0, in the order of LineLaws.
std::vector<AnyLineLaw> line_laws();
/// Returns the name of a law in files, options and messages.
std::string_view name_of(const AnyLineLaw& law);
/// The names of line_laws(), in the same order.
std::vector<std::string> line_law_names();

/// A line or polyline to follow. The run ends when the vehicle has passed its end.
struct LinePath {
  std::vector<Position<double>> points_m;  ///< corners, at least two
  AnyLineLaw law{};
  /// >= 0, see Polyline::corner_m. 0 for a law that does not use it.
  double corner_m = 0.0;
  std::optional<double> slow_down_m;  ///< see WaypointPath; the distance is along the last segment
};

/// A timed path: the vehicle follows a point that moves along a curve. If the scenario's speed_mps
/// is 0, the speed of the point is commanded. Another speed_mps is allowed only without position
/// feedback.
struct LissajousPath {
  Lissajous<double> path{};
  bool closed_loop = false;          ///< with position feedback
  double position_gain_per_s = 0.5;  ///< k of closed_path(), > 0
  /// The run counts as completed if, in its second half, the vehicle stays within this distance of
  /// the moving point, m.
  double tolerance_m = 1.0;
};

using Guidance = std::variant<OpenLoop, HeadingSteps, WaypointPath, LinePath, LissajousPath>;

/// The simulated plant: kModel, the 3-DOF equations of the model; kFourWheel, its rigid body on
/// four tyres.
enum class PlantKind { kModel, kFourWheel };
inline constexpr NameTable<PlantKind, 2> kPlantKindNames{
    {{"model", PlantKind::kModel}, {"four-wheel", PlantKind::kFourWheel}}};

/// How the guidance gets the position from the fixes of a GPS.
enum class PositionMethod {
  kFilter,  ///< by the firmware's estimate (control/position_estimate.h)
  kNone,    ///< the last fix, unfiltered
};
inline constexpr NameTable<PositionMethod, 2> kPositionMethodNames{
    {{"filter", PositionMethod::kFilter}, {"none", PositionMethod::kNone}}};

/// A scenario: one run to simulate. An absent optional field switches its feature off, unless its
/// comment says otherwise.
struct Scenario {
  std::string name;
  double duration_s = 0.0;  ///< s, > 0
  State<double> initial{};  ///< the initial state
  double speed_mps = 0.0;   ///< u_d, m/s, >= 0: commanded speed; 0 if tau_speed is constant
  Guidance guidance;
  std::vector<Obstacle<double>> obstacles = {};
  /// absent: the distance to obstacles is only recorded
  std::optional<Avoidance<double>> avoidance = {};
  std::optional<HeadingShaping<double>> shaping = {};
  Disturbance disturbance = {};
  std::vector<WheelFault> faults = {};
  std::vector<SlipperyPatch> patches = {};
  std::optional<Battery> battery = {};  ///< absent: constant voltage
  std::optional<Sensors> sensors = {};  ///< absent: the controller measures the true state
  PositionMethod estimator = PositionMethod::kFilter;  ///< how the guidance gets the position from
                                                       ///< GPS fixes; no effect without a GPS
  std::optional<Actuators> actuators = {};  ///< absent: exact commands, motors without lag
  ControlOptions control = {};
  /// plant parameters to set to an end of their 95 % interval; the controller keeps the estimates
  std::vector<CornerParameter> corner = {};
  /// Tyres of the four-wheel plant (model/tyres.h). Absent: the plant is the 3-DOF model.
  std::optional<Tyres<double>> tyres = {};
  std::uint64_t seed = 0;  ///< seed of all random numbers in the scenario

  /// Returns the constant tau_speed that replaces the speed law (HeadingSteps::tau_speed). Absent
  /// if there is none, and in open loop.
  std::optional<double> held_tau_speed() const;
  /// True if anything in the scenario is random, such as sensor noise.
  bool random() const;
};

/// True if the position is estimated from the fixes of a GPS.
inline bool estimates_position(const Scenario& scenario) {
  return scenario.sensors && scenario.sensors->gps && scenario.estimator == PositionMethod::kFilter;
}

/// Options of heading_steps().
struct HeadingStepsOptions {
  double hold_s = 10.0;    ///< > 0: duration of each heading
  double speed_mps = 1.0;  ///< u_d: commanded speed, >= 0
  std::string name = "heading steps";
};

/// Returns the scenario of the paper's heading runs: the vehicle starts at rest at heading 0, and
/// each of `headings_deg` (counter-clockwise positive; not empty) is commanded in turn.
/// heading_steps({30, -30}) is the paper's scenario C3. [paper 4.3]
Scenario heading_steps(const std::vector<double>& headings_deg,
                       const HeadingStepsOptions& options = {});

/// A key of the scenario file that cannot be used together with the key `tyres`.
struct TyreConflict {
  std::string key;
  std::string message;  ///< the reason and the remedy
};
/// Returns the keys of the scenario that conflict with the key `tyres`, even if the scenario has no
/// such key yet.
std::vector<TyreConflict> tyre_conflicts(const Scenario& scenario);

/// Checks the keys of a scenario with tyres. Errors (input): there is one of tyre_conflicts().
Status check_tyres(const Scenario& scenario);

/// Checks that the scenario can be simulated with this model. Errors (input): those of
/// check_tyres() and check_observer_rate(); an LQI law that is unstable at the vehicle's sample
/// time; a motor fault of wheels without motors.
Status check_scenario(const Scenario& scenario, const Model& model);

/// Returns a description of the simulated plant: "model", or "four-wheel, friction 0.8, ..." with
/// the parameters of the tyres.
std::string plant_text(const Scenario& scenario);

/// Returns the model with each parameter in Scenario::corner set to the end of its 95 % interval
/// that corner names. Errors (input): such a parameter has no interval.
Result<Model> model_at_corner(Model model, const Scenario& scenario);
/// Returns the plant of model_at_corner(), with the parameters that `motion` (planar or straight)
/// needs. Errors (input): those of model_at_corner(), check_scenario(), Model::plant() and
/// check_work() (simulate.h).
Result<Plant<double>> plant_for(const Scenario& scenario, const Model& model,
                                Motion motion = Motion::kPlanar);

inline constexpr NameTable<CombinedSplit, 2> kCombinedSplitNames{
    {{"redistribute", CombinedSplit::kRedistribute}, {"fixed_half", CombinedSplit::kFixedHalf}}};
/// Returns the yaw modes that the vehicle can use, in the order of kYawModes. A vehicle without
/// steering has differential mode only.
std::span<const YawMode> yaw_modes(const Vehicle& vehicle);
/// Checks that the vehicle can use this yaw mode. Errors (input): the mode needs steering, and the
/// vehicle has none.
Status check_mode(const Vehicle& vehicle, YawMode mode);

}  // namespace awmr
