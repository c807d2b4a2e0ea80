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
#include "awmr/model/model.h"
#include "awmr/model/state.h"
#include "awmr/model/tyres.h"
#include "awmr/simulate/world.h"

namespace awmr {

/// Open loop: constant generalised forces. The allocation of the yaw mode limits them and converts
/// them to commands.
struct OpenLoop {
  double tau_speed = 0.0;   ///< thrust over F_max, dimensionless, forward positive
  double tau_turn_m = 0.0;  ///< yaw moment over F_max, m, counter-clockwise positive
};

/// A heading and the time from which it is commanded.
struct HeadingStep {
  double t_s = 0.0;      ///< start of the command, s, >= 0
  double psi_rad = 0.0;  ///< rad, counter-clockwise from the world's x axis
};

/// A sequence of commanded headings; each holds until the next. The first is commanded at t = 0.
struct HeadingSteps {
  std::vector<HeadingStep> steps;  ///< strictly increasing in time, not empty
  /// Constant thrust tau_speed, dimensionless, forward positive, as in the paper's experiment. It
  /// replaces the speed law, and there is no surge observer. Absent: the speed law controls the
  /// scenario's speed_mps.
  std::optional<double> tau_speed = {};
};

/// Waypoints, approached by line of sight. The run ends when the last is reached.
struct WaypointPath {
  std::vector<Position<double>> points_m;  ///< not empty
  double acceptance_m = 0.0;               ///< a point is reached within this distance, > 0
  bool skip_passed = false;                ///< see Waypoints::skip_passed
  /// m, > 0: within this distance of the last point, the reference speed is reduced in proportion
  /// to the distance, but not below a tenth of speed_mps. Absent: the speed is not reduced.
  std::optional<double> slow_down_m;
};

/// A line-following law with its parameters: the paper's line of sight, or a law for comparison.
using AnyLineLaw = LineLaws<std::variant, double>;
/// Each law, with parameters of 0, in the order of LineLaws.
std::vector<AnyLineLaw> line_laws();
/// A law's name in files, options and messages.
std::string_view name_of(const AnyLineLaw& law);
/// The names of line_laws(), in the same order.
std::vector<std::string> line_law_names();

/// A line or polyline to follow. The run ends when the vehicle has passed its end.
struct LinePath {
  std::vector<Position<double>> points_m;  ///< corners, at least two
  AnyLineLaw law{};
  double corner_m = 0.0;              ///< >= 0, see Polyline::corner_m; 0 for a law without corner
                                      ///< rounding
  std::optional<double> slow_down_m;  ///< see WaypointPath; distance along the last segment
};

/// A timed path: a point that moves along a curve. The commanded speed is that of the point if the
/// scenario's speed_mps is 0, else speed_mps. The latter is allowed only without position feedback.
struct LissajousPath {
  Lissajous<double> path{};
  bool closed_loop = false;          ///< with position feedback
  double position_gain_per_s = 0.5;  ///< k of closed_path(), > 0
  double tolerance_m = 1.0;  ///< largest distance from the path's point in the second half of a run
                             ///< that counts as completed
};

using Guidance = std::variant<OpenLoop, HeadingSteps, WaypointPath, LinePath, LissajousPath>;

/// The simulated plant: the model's 3-DOF equations, or its rigid body on four tyres.
enum class PlantKind { kModel, kFourWheel };
inline constexpr NameTable<PlantKind, 2> kPlantKindNames{
    {{"model", PlantKind::kModel}, {"four-wheel", PlantKind::kFourWheel}}};

/// Method by which the guidance gets the position from the fixes of a GPS.
enum class PositionMethod {
  kFilter,  ///< the firmware's estimate (control/position_estimate.h)
  kNone,    ///< the last fix, unfiltered
};
inline constexpr NameTable<PositionMethod, 2> kPositionMethodNames{
    {{"filter", PositionMethod::kFilter}, {"none", PositionMethod::kNone}}};

/// One run to simulate. If an optional field is absent, its feature is off, unless the comment of
/// the field says otherwise.
struct Scenario {
  std::string name;
  double duration_s = 0.0;  ///< s, > 0
  State<double> initial{};  ///< the initial state
  double speed_mps = 0.0;   ///< u_d, m/s, >= 0; 0 with a constant tau_speed
  Guidance guidance;
  std::vector<Obstacle<double>> obstacles = {};
  std::optional<Avoidance<double>> avoidance = {};  ///< absent: obstacles are only measured
  std::optional<HeadingShaping<double>> shaping = {};
  Disturbance disturbance = {};
  std::vector<WheelFault> faults = {};
  std::vector<SlipperyPatch> patches = {};
  std::optional<Battery> battery = {};  ///< absent: constant voltage
  std::optional<Sensors> sensors = {};  ///< absent: the controller measures the true state
  PositionMethod estimator = PositionMethod::kFilter;  ///< used only if there is a GPS
  std::optional<Actuators> actuators = {};  ///< absent: exact commands, motors without lag
  ControlOptions control = {};
  std::vector<CornerParameter> corner = {};  ///< changes the plant, not the controller
  /// Absent: the 3-DOF plant of the model; else four wheels on these tyres (model/tyres.h).
  std::optional<Tyres<double>> tyres = {};
  std::uint64_t seed = 0;  ///< seed of all random numbers in the scenario

  /// The constant tau_speed that replaces a commanded speed (HeadingSteps::tau_speed). Absent if a
  /// speed is commanded, and in open loop.
  std::optional<double> held_tau_speed() const;
  /// True if anything in the scenario is random.
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

/// The scenario of the paper's heading runs: from rest at heading 0, each of `headings_deg`
/// (counter-clockwise positive; not empty) is commanded in turn. heading_steps({30, -30}) is C3.
/// [paper 4.3]
Scenario heading_steps(const std::vector<double>& headings_deg,
                       const HeadingStepsOptions& options = {});

/// A key of the scenario file that is invalid together with the key `tyres`.
struct TyreConflict {
  std::string key;
  std::string message;  ///< the reason and the remedy
};
/// The keys of the scenario that conflict with the key `tyres`. They are returned even if the
/// scenario has no tyres, for callers that want to add tyres.
std::vector<TyreConflict> tyre_conflicts(const Scenario& scenario);

/// Errors (input): the scenario has tyres and one of tyre_conflicts().
Status check_tyres(const Scenario& scenario);

/// Checks that the scenario can run with this model. Errors (input): those of check_tyres() and
/// check_observer_rate(); an LQI law that is unstable at the vehicle's sample time; a motor fault
/// of wheels without motors.
Status check_scenario(const Scenario& scenario, const Model& model);

/// Description of the simulated plant: "model", or "four-wheel, friction 0.8, ..." with the numbers
/// of the tyres.
std::string plant_text(const Scenario& scenario);

/// The model with each parameter of Scenario::corner set to the end of its 95 % interval.
/// Errors (input): a parameter of the corner has no interval.
Result<Model> model_at_corner(Model model, const Scenario& scenario);
/// The plant of model_at_corner(), with the parameters that `motion` needs. Errors (input): those
/// of model_at_corner(), check_scenario(), Model::plant() and check_work() (simulate.h).
Result<Plant<double>> plant_for(const Scenario& scenario, const Model& model,
                                Motion motion = Motion::kPlanar);

inline constexpr NameTable<YawMode, 3> kYawModeNames{{{"differential", YawMode::kDifferential},
                                                      {"steering", YawMode::kSteering},
                                                      {"combined", YawMode::kCombined}}};
inline constexpr NameTable<CombinedSplit, 2> kCombinedSplitNames{
    {{"redistribute", CombinedSplit::kRedistribute}, {"fixed_half", CombinedSplit::kFixedHalf}}};
constexpr std::string_view name_of(YawMode mode) { return name_in(kYawModeNames, mode); }
inline constexpr YawMode kYawModes[] = {YawMode::kDifferential, YawMode::kSteering,
                                        YawMode::kCombined};
/// Modes of the vehicle, in the order of kYawModes; without steering, differential only.
std::span<const YawMode> yaw_modes(const Vehicle& vehicle);
/// Checks that the vehicle has this mode. Errors (input): the mode needs steering, and the vehicle
/// has none.
Status check_mode(const Vehicle& vehicle, YawMode mode);

}  // namespace awmr
