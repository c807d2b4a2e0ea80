// Reads the disturbance, faults, slippery, battery, sensors, estimator, actuators, control, corner
// and tyres of scenario.json.

#include <fmt/format.h>

#include <array>
#include <string>

#include "awmr/core/name_table.h"
#include "awmr/core/units.h"
#include "awmr/model/ranges.h"
#include "awmr/simulate/scenario_json.h"

namespace awmr {
namespace {

constexpr NumberRule kShare{.min = 0.0, .max = 1.0};
constexpr NumberRule kSag{.min = 0.0, .max = 10.0};

/// Message about a window of time whose end is not after its start.
std::string not_after(double from_s, double to_s) {
  return fmt::format(
      "the end, to_s = {:g} s, is not after from_s = {:g} s; exchange or correct them", to_s,
      from_s);
}

Window read_window(JsonObject& json) {
  Window window;
  window.from_s = json.optional_number("from_s", kTime_s).value_or(window.from_s);
  window.to_s = json.optional_number("to_s", kTime_s).value_or(window.to_s);
  if (!(window.to_s > window.from_s)) {
    json.fault(ErrorCode::kWrongOrder, "to_s", not_after(window.from_s, window.to_s));
  }
  return window;
}

/// Types of disturbance terms in a scenario file. A `step` is read as a constant that begins at
/// t_s.
enum class TermType { kConstant, kStep, kSine, kNoise };
constexpr NameTable<TermType, 4> kTermTypes{{{"constant", TermType::kConstant},
                                             {"step", TermType::kStep},
                                             {"sine", TermType::kSine},
                                             {"noise", TermType::kNoise}}};

DisturbanceTerm read_term(JsonObject& json) {
  DisturbanceTerm term;
  const TermType type = json.choice("type", kTermTypes);
  if (type == TermType::kSine) {
    term.kind = DisturbanceTerm::Kind::kSine;
    term.value = json.number("amplitude", kForce);
    term.frequency_hz = json.number("frequency_hz", kRate);
    if (const auto phase_deg = json.optional_number("phase_deg", kAngle_deg)) {
      term.phase_rad = radians(*phase_deg);
    }
  } else if (type == TermType::kNoise) {
    term.kind = DisturbanceTerm::Kind::kNoise;
    term.value = json.number("std", kForceSize);
    term.bandwidth_hz = json.number("bandwidth_hz", kRate);
  } else {
    term.value = json.number("value", kForce);
  }
  if (type == TermType::kStep) {
    term.window.from_s = json.number("t_s", kTime_s);
  } else {
    term.window = read_window(json);
  }
  return term;
}

Slope read_slope(JsonObject& json) {
  return {radians(json.number("angle_deg", {.min = 0.0, .max = 45.0})),
          radians(json.number("downhill_deg", kAngle_deg))};
}

Disturbance read_disturbance(JsonObject& json) {
  return {.surge = json.optional_objects("surge", read_term),
          .sway = json.optional_objects("sway", read_term),
          .yaw = json.optional_objects("yaw", read_term),
          .slope = json.optional_object("slope", read_slope)};
}

WheelFault read_fault(JsonObject& json) {
  static const std::array<std::string, 6> kNames{"front_left", "front_right", "rear_left",
                                                 "rear_right", "left",        "right"};
  static const std::vector<Wheel> kWheels[] = {{Wheel::kFrontLeft},
                                               {Wheel::kFrontRight},
                                               {Wheel::kRearLeft},
                                               {Wheel::kRearRight},
                                               {Wheel::kFrontLeft, Wheel::kRearLeft},
                                               {Wheel::kFrontRight, Wheel::kRearRight}};
  return {.wheels = kWheels[json.choice("wheel", kNames)],
          .window = read_window(json),
          .share = json.number("share", kShare)};
}

SlipperyPatch read_patch(JsonObject& json) {
  return {.centre_m = {json.number("x_m", kCoordinate_m), json.number("y_m", kCoordinate_m)},
          .radius_m = json.number("radius_m", kLength_m),
          .force_max = json.number("force_max", kForceSize)};
}

Battery read_battery(JsonObject& json) {
  Battery battery{.sag = json.optional_number("sag", kSag).value_or(0.0)};
  const bool runs_down = json.has("from_s") || json.has("to_s") || json.has("share_end");
  if (runs_down || !json.has("sag")) {
    battery.from_s = json.number("from_s", kTime_s);
    battery.to_s = json.number("to_s", kDuration_s);
    battery.share_end = json.number("share_end", kShare);
    if (!(battery.to_s > battery.from_s)) {
      json.fault(ErrorCode::kWrongOrder, "to_s", not_after(battery.from_s, battery.to_s));
    }
  }
  return battery;
}

/// Reads the errors of a sensor. `unit`: factor from the unit of the file to that of the program.
Channel read_channel(JsonObject& json, double unit) {
  return {.noise = unit * json.optional_number("noise", kSensorSize).value_or(0.0),
          .bias = unit * json.optional_number("bias", kSensorBias).value_or(0.0),
          .quantum = unit * json.optional_number("quantum", kSensorSize).value_or(0.0),
          .latency_s = json.optional_number("latency_s", kLatency_s).value_or(0.0),
          .correlation_s = json.optional_number("correlation_s", kCorrelation_s).value_or(0.0)};
}

Gps read_gps(JsonObject& json) {
  Gps gps;
  gps.rate_hz = json.number("rate_hz", {.min = 0.0, .max = 1000.0, .min_excluded = true});
  gps.latency_s = json.number("latency_s", kTime_s);
  gps.x.noise = json.number("noise_m", kSensorSize);
  gps.x.quantum = json.optional_number("quantum_m", kSensorSize).value_or(0.0);
  gps.y = gps.x;
  gps.dropouts = json.optional_objects("dropouts", read_window);
  return gps;
}

Sensors read_sensors(JsonObject& json) {
  Sensors sensors;
  const auto channel = [&](const char* key, double unit) {
    const auto read = [unit](JsonObject& object) { return read_channel(object, unit); };
    return json.optional_object(key, read).value_or(Channel{});
  };
  sensors.heading = channel("heading_deg", radians(1.0));
  sensors.yaw_rate = channel("yaw_rate_degps", radians(1.0));
  sensors.speed = channel("speed_mps", 1.0);
  sensors.sway_measured = json.optional_boolean("sway_measured").value_or(true);
  sensors.speed_signed = json.optional_boolean("speed_signed").value_or(true);
  sensors.gps = json.optional_object("gps", read_gps);
  return sensors;
}

/// Returns the smallest change of the steering angle that the servo can make, rad. Keys:
/// `us_per_deg`, the change of its pulse width per degree of steering, microseconds; `step_us`, the
/// resolution of the pulse width, microseconds (0.5 for a timer of an ATmega at 2 MHz).
double read_servo(JsonObject& json) {
  const double us_per_deg = json.number("us_per_deg", kRate);
  return radians(json.number("step_us", kRate) / us_per_deg);
}

double read_motor(JsonObject& json) { return json.number("time_constant_s", kLatency_s); }

Actuators read_actuators(JsonObject& json) {
  return {.steering_quantum_rad = json.optional_object("servo", read_servo).value_or(0.0),
          .pwm_counts = static_cast<int>(json.optional_integer("pwm_counts", 1, 65535).value_or(0)),
          .motor_time_constant_s = json.optional_object("motor", read_motor).value_or(0.0)};
}

enum class HeadingLaw { kSlidingMode, kLqi };
constexpr NameTable<HeadingLaw, 2> kHeadingLaws{
    {{"sliding_mode", HeadingLaw::kSlidingMode}, {"lqi", HeadingLaw::kLqi}}};

// Permitted ranges of the LQI weights. The upper ends exceed the range of any sensor; the gains are
// always finite.
constexpr NumberRule kLqiHeading_deg{.min = 1e-3, .max = 180.0};
constexpr NumberRule kLqiYawRate_degps{.min = 1e-3, .max = 1e5};
constexpr NumberRule kLqiIntegral_deg_s{.min = 1e-3, .max = 1e6};
constexpr NumberRule kLqiMoment_m{.min = 1e-6, .max = 1e3};

/// Reads the heading law. The result has the weights of the LQI, and is empty for the sliding mode.
std::optional<LqiWeights<double>> read_heading_law(JsonObject& json) {
  if (json.choice("type", kHeadingLaws) == HeadingLaw::kSlidingMode) return std::nullopt;
  return LqiWeights<double>{
      .heading_rad = radians(json.number("heading_deg", kLqiHeading_deg)),
      .yaw_rate_radps = radians(json.number("yaw_rate_degps", kLqiYawRate_degps)),
      .integral_rad_s = radians(json.number("integral_deg_s", kLqiIntegral_deg_s)),
      .tau_turn_m = json.number("tau_turn_m", kLqiMoment_m)};
}

ControlOptions read_control(JsonObject& json) {
  ControlOptions control;
  if (json.has("combined_split"))
    control.split = json.choice("combined_split", kCombinedSplitNames);
  if (json.has("allocation")) control.allocation = json.choice("allocation", kAllocationFormNames);
  control.lqi = json.optional_object("heading_law", read_heading_law).value_or(std::nullopt);
  control.observer = json.optional_object("disturbance_observer", [&](JsonObject& object) {
    const ObserverGains<double> observer{.bandwidth_radps = object.number("bandwidth_radps", kRate),
                                         .yaw_max_m = object.number("yaw_max_m", kRate),
                                         .surge_max = object.number("surge_max", kRate)};
    control.anti_windup = object.boolean("anti_windup");
    return observer;
  });
  return control;
}

std::vector<CornerParameter> read_corner(JsonObject& json) {
  static constexpr NameTable<bool, 2> kHigh{{{"lo", false}, {"hi", true}}};
  std::vector<CornerParameter> corner;
  for (const std::string& name : json.keys()) {
    const bool high = json.choice(name, kHigh);
    if (const auto id = parameter_by_name(name)) {
      corner.push_back({*id, high});
    } else {
      std::string known;
      for (const ParameterInfo& parameter : parameter_table()) {
        known += (known.empty() ? "" : ", ") + std::string(parameter.name);
      }
      json.fault(ErrorCode::kUnknownName, name, "is not a parameter; use one of: " + known);
    }
  }
  return corner;
}

Tyres<double> read_tyres(JsonObject& json) {
  Tyres<double> tyres;
  tyres.friction = json.optional_number("friction", kTyreFrictionRule).value_or(tyres.friction);
  tyres.cornering_per_rad =
      json.optional_number("cornering_stiffness_per_rad", kCorneringStiffnessRule_per_rad)
          .value_or(tyres.cornering_per_rad);
  tyres.rest_speed_mps =
      json.optional_number("rest_speed_mps", kTyreRestSpeedRule_mps).value_or(tyres.rest_speed_mps);
  return tyres;
}

}  // namespace

void read_world(JsonObject& json, Scenario& scenario) {
  scenario.disturbance =
      json.optional_object("disturbance", read_disturbance).value_or(Disturbance{});
  scenario.faults = json.optional_objects("faults", read_fault);
  scenario.patches = json.optional_objects("slippery", read_patch);
  scenario.battery = json.optional_object("battery", read_battery);
  scenario.sensors = json.optional_object("sensors", read_sensors);
  if (json.has("estimator")) scenario.estimator = json.choice("estimator", kPositionMethodNames);
  scenario.actuators = json.optional_object("actuators", read_actuators);
  scenario.control = json.optional_object("control", read_control).value_or(ControlOptions{});
  scenario.corner =
      json.optional_object("corner", read_corner).value_or(std::vector<CornerParameter>{});
  scenario.tyres = json.optional_object("tyres", read_tyres);
}

}  // namespace awmr
