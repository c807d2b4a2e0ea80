/// The vehicle's task and its world. Its file: scenario_file.h.
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

/// Constant generalised forces, with the allocation and the limits of the mode.
struct OpenLoop {
  double tau_speed = 0.0;   ///< dimensionless, forward positive
  double tau_turn_m = 0.0;  ///< m, counter-clockwise positive
};

/// A heading and the time from which it is commanded.
struct HeadingStep {
  double t_s = 0.0;      ///< s, >= 0
  double psi_rad = 0.0;  ///< rad, counter-clockwise from the world's x axis
};

/// Commanded headings, each from its time on; the first at t = 0.
struct HeadingSteps {
  std::vector<HeadingStep> steps;  ///< strictly increasing in time, not empty
  /// Constant tau_speed in place of a speed, dimensionless, forward positive, as in the paper's
  /// experiment: without speed law and surge observer. Absent: the speed law controls the
  /// scenario's speed_mps.
  std::optional<double> tau_speed = {};
};

/// Waypoints, approached by line of sight. The run ends when the last is reached.
struct WaypointPath {
  std::vector<Position<double>> points_m;  ///< not empty
  double acceptance_m = 0.0;               ///< > 0
  bool skip_passed = false;                ///< see Waypoints::skip_passed
  /// Within this distance of the last point the speed is reduced in proportion to it, but not below
  /// a tenth.
  std::optional<double> slow_down_m;
};

/// A line-following law: the paper's line of sight, or a baseline.
using AnyLineLaw = LineLaws<std::variant, double>;
/// Each law, with parameters of 0, in the order of LineLaws.
std::vector<AnyLineLaw> line_laws();
/// A law's name in files, options and messages.
std::string_view name_of(const AnyLineLaw& law);
/// The names of line_laws(), in the same order.
std::vector<std::string> line_law_names();

/// A line or polyline to follow. The run ends past its end.
struct LinePath {
  std::vector<Position<double>> points_m;  ///< at least two
  AnyLineLaw law{};
  double corner_m = 0.0;              ///< >= 0, see Polyline::corner_m; 0 for a law without corner
                                      ///< rounding
  std::optional<double> slow_down_m;  ///< as in WaypointPath, along the last segment
};

/// A path as a function of time. With the scenario's speed_mps 0, the speed is the path's own; else
/// it is that constant (open form only).
struct LissajousPath {
  Lissajous<double> path{};
  bool closed_loop = false;
  double position_gain_per_s = 0.5;  ///< k of the closed form, > 0
  double tolerance_m = 1.0;  ///< completed if the distance from the path is within this in the
                             ///< second half
};

using Guidance = std::variant<OpenLoop, HeadingSteps, WaypointPath, LinePath, LissajousPath>;

/// The simulated plant: the model's 3-DOF equations, or its rigid body on four tyres.
enum class PlantKind { kModel, kFourWheel };
inline constexpr NameTable<PlantKind, 2> kPlantKindNames{
    {{"model", PlantKind::kModel}, {"four-wheel", PlantKind::kFourWheel}}};

/// Position of the guidance from the fixes of a GPS.
enum class PositionMethod {
  kFilter,  ///< the firmware's estimate (control/position_estimate.h)
  kNone,    ///< the last fix, unfiltered
};
inline constexpr NameTable<PositionMethod, 2> kPositionMethodNames{
    {{"filter", PositionMethod::kFilter}, {"none", PositionMethod::kNone}}};

/// One run to simulate. Absent optional fields are off.
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
  PositionMethod estimator = PositionMethod::kFilter;  ///< for scenarios with a GPS
  std::optional<Actuators> actuators = {};  ///< absent: any force and angle can be commanded
  ControlOptions control = {};
  std::vector<CornerParameter> corner = {};  ///< of the plant only, not of the controller
  /// Absent: the 3-DOF plant of the model; else four wheels on these tyres (model/tyres.h).
  std::optional<Tyres<double>> tyres = {};
  std::uint64_t seed = 0;  ///< of all random numbers in the scenario

  /// The constant thrust in place of a speed; absent with a speed or in open loop.
  std::optional<double> held_tau_speed() const;
  /// True if anything in the scenario is random.
  bool random() const;
};

/// True if the position is estimated from the fixes of a GPS.
inline bool estimates_position(const Scenario& scenario) {
  return scenario.sensors && scenario.sensors->gps && scenario.estimator == PositionMethod::kFilter;
}

struct HeadingStepsOptions {
  double hold_s = 10.0;    ///< > 0: duration of each heading
  double speed_mps = 1.0;  ///< u_d, >= 0
  std::string name = "heading steps";
};

/// The scenario of the paper's heading runs: from rest at heading 0, each heading (deg,
/// counter-clockwise positive; not empty) in turn. heading_steps({30, -30}) is C3.
/// [paper 4.3]
Scenario heading_steps(const std::vector<double>& headings_deg,
                       const HeadingStepsOptions& options = {});

/// Keys of the scenario that do not apply on tyres, each with the remedy.
struct TyreConflict {
  std::string key;
  std::string message;
};
std::vector<TyreConflict> tyre_conflicts(const Scenario& scenario);

/// Errors (input): the scenario has tyres together with a key that has no meaning on tyres.
Status check_tyres(const Scenario& scenario);

/// Errors (input): a controller with the model's own values cannot run the scenario: as check_tyres
/// and check_observer_rate, and an LQI law that is unstable at the sample time.
Status check_scenario(const Scenario& scenario, const Model& model);

/// Description of the plant: "model", or "four-wheel, friction 0.8, ..." with the numbers of the
/// tyres.
std::string plant_text(const Scenario& scenario);

/// The model with the scenario's corner parameters at the ends of their 95 % intervals.
/// Errors (input): a parameter of the corner has no interval.
Result<Model> model_at_corner(Model model, const Scenario& scenario);
/// The plant of model_at_corner(). Errors (input): as there, as check_scenario, as Model::plant and
/// as check_work (in simulate.h).
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
/// Errors (input): the mode needs steering and the vehicle has none.
Status check_mode(const Vehicle& vehicle, YawMode mode);

}  // namespace awmr
