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
  json.reject_unknown_keys();
  return term;
}

std::vector<DisturbanceTerm> read_terms(JsonObject& json, const char* key) {
  std::vector<DisturbanceTerm> terms;
  for (JsonObject& term : json.optional_objects(key)) terms.push_back(read_term(term));
  return terms;
}

Disturbance read_disturbance(JsonObject json) {
  Disturbance disturbance{.surge = read_terms(json, "surge"),
                          .sway = read_terms(json, "sway"),
                          .yaw = read_terms(json, "yaw"),
                          .slope = {}};
  if (auto slope = json.optional_object("slope")) {
    disturbance.slope = Slope{radians(slope->number("angle_deg", {.min = 0.0, .max = 45.0})),
                              radians(slope->number("downhill_deg", kAngle_deg))};
    slope->reject_unknown_keys();
  }
  json.reject_unknown_keys();
  return disturbance;
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
  WheelFault fault{.wheels = kWheels[json.choice("wheel", kNames)],
                   .window = read_window(json),
                   .share = json.number("share", kShare)};
  json.reject_unknown_keys();
  return fault;
}

SlipperyPatch read_patch(JsonObject& json) {
  SlipperyPatch patch{
      .centre_m = {json.number("x_m", kCoordinate_m), json.number("y_m", kCoordinate_m)},
      .radius_m = json.number("radius_m", kLength_m),
      .force_max = json.number("force_max", kForceSize)};
  json.reject_unknown_keys();
  return patch;
}

Battery read_battery(JsonObject json) {
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
  json.reject_unknown_keys();
  return battery;
}

/// Reads the errors of a sensor. `unit`: factor from the unit of the file to that of the program.
Channel read_channel(JsonObject json, double unit) {
  Channel channel{
      .noise = unit * json.optional_number("noise", kSensorSize).value_or(0.0),
      .bias = unit * json.optional_number("bias", kSensorBias).value_or(0.0),
      .quantum = unit * json.optional_number("quantum", kSensorSize).value_or(0.0),
      .latency_s = json.optional_number("latency_s", kLatency_s).value_or(0.0),
      .correlation_s = json.optional_number("correlation_s", kCorrelation_s).value_or(0.0)};
  json.reject_unknown_keys();
  return channel;
}

Gps read_gps(JsonObject json) {
  Gps gps;
  gps.rate_hz = json.number("rate_hz", {.min = 0.0, .max = 1000.0, .min_excluded = true});
  gps.latency_s = json.number("latency_s", kTime_s);
  gps.x.noise = json.number("noise_m", kSensorSize);
  gps.x.quantum = json.optional_number("quantum_m", kSensorSize).value_or(0.0);
  gps.y = gps.x;
  for (JsonObject& window : json.optional_objects("dropouts")) {
    gps.dropouts.push_back(read_window(window));
    window.reject_unknown_keys();
  }
  json.reject_unknown_keys();
  return gps;
}

Sensors read_sensors(JsonObject json) {
  Sensors sensors;
  const auto channel = [&](const char* key, double unit) {
    const auto object = json.optional_object(key);
    return object ? read_channel(*object, unit) : Channel{};
  };
  sensors.heading = channel("heading_deg", radians(1.0));
  sensors.yaw_rate = channel("yaw_rate_degps", radians(1.0));
  sensors.speed = channel("speed_mps", 1.0);
  sensors.sway_measured = json.optional_boolean("sway_measured").value_or(true);
  sensors.speed_signed = json.optional_boolean("speed_signed").value_or(true);
  if (auto gps = json.optional_object("gps")) sensors.gps = read_gps(*gps);
  json.reject_unknown_keys();
  return sensors;
}

/// Reads the actuators. Keys of the servo: `us_per_deg`, the change of its pulse width per degree
/// of steering, microseconds; `step_us`, the resolution of the pulse width, microseconds (0.5 for a
/// timer of an ATmega at 2 MHz).
Actuators read_actuators(JsonObject json) {
  Actuators actuators;
  if (auto servo = json.optional_object("servo")) {
    const double us_per_deg = servo->number("us_per_deg", kRate);
    actuators.steering_quantum_rad = radians(servo->number("step_us", kRate) / us_per_deg);
    servo->reject_unknown_keys();
  }
  actuators.pwm_counts =
      static_cast<int>(json.optional_integer("pwm_counts", 1, 65535).value_or(0));
  if (auto motor = json.optional_object("motor")) {
    actuators.motor_time_constant_s = motor->number("time_constant_s", kLatency_s);
    motor->reject_unknown_keys();
  }
  json.reject_unknown_keys();
  return actuators;
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
std::optional<LqiWeights<double>> read_heading_law(JsonObject json) {
  std::optional<LqiWeights<double>> lqi;
  if (json.choice("type", kHeadingLaws) == HeadingLaw::kLqi) {
    lqi = {.heading_rad = radians(json.number("heading_deg", kLqiHeading_deg)),
           .yaw_rate_radps = radians(json.number("yaw_rate_degps", kLqiYawRate_degps)),
           .integral_rad_s = radians(json.number("integral_deg_s", kLqiIntegral_deg_s)),
           .tau_turn_m = json.number("tau_turn_m", kLqiMoment_m)};
  }
  json.reject_unknown_keys();
  return lqi;
}

ControlOptions read_control(JsonObject json) {
  ControlOptions control;
  if (json.has("combined_split"))
    control.split = json.choice("combined_split", kCombinedSplitNames);
  if (json.has("allocation")) control.allocation = json.choice("allocation", kAllocationFormNames);
  if (auto law = json.optional_object("heading_law")) control.lqi = read_heading_law(*law);
  if (auto observer = json.optional_object("disturbance_observer")) {
    control.observer =
        ControlOptions::Observer{.bandwidth_radps = observer->number("bandwidth_radps", kRate),
                                 .yaw_max_m = observer->number("yaw_max_m", kRate),
                                 .surge_max = observer->number("surge_max", kRate),
                                 .anti_windup = observer->boolean("anti_windup")};
    observer->reject_unknown_keys();
  }
  json.reject_unknown_keys();
  return control;
}

std::vector<CornerParameter> read_corner(JsonObject json) {
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

Tyres<double> read_tyres(JsonObject json) {
  Tyres<double> tyres;
  tyres.friction = json.optional_number("friction", kTyreFrictionRule).value_or(tyres.friction);
  tyres.cornering_per_rad =
      json.optional_number("cornering_stiffness_per_rad", kCorneringStiffnessRule_per_rad)
          .value_or(tyres.cornering_per_rad);
  tyres.rest_speed_mps =
      json.optional_number("rest_speed_mps", kTyreRestSpeedRule_mps).value_or(tyres.rest_speed_mps);
  json.reject_unknown_keys();
  return tyres;
}

}  // namespace

void read_world(JsonObject& json, Scenario& scenario) {
  if (auto object = json.optional_object("disturbance")) {
    scenario.disturbance = read_disturbance(*object);
  }
  for (JsonObject& fault : json.optional_objects("faults")) {
    scenario.faults.push_back(read_fault(fault));
  }
  for (JsonObject& patch : json.optional_objects("slippery")) {
    scenario.patches.push_back(read_patch(patch));
  }
  if (auto object = json.optional_object("battery")) scenario.battery = read_battery(*object);
  if (auto object = json.optional_object("sensors")) scenario.sensors = read_sensors(*object);
  if (json.has("estimator")) scenario.estimator = json.choice("estimator", kPositionMethodNames);
  if (auto object = json.optional_object("actuators")) {
    scenario.actuators = read_actuators(*object);
  }
  if (auto object = json.optional_object("control")) scenario.control = read_control(*object);
  if (auto object = json.optional_object("corner")) scenario.corner = read_corner(*object);
  if (auto object = json.optional_object("tyres")) scenario.tyres = read_tyres(*object);
}

}  // namespace awmr
