#include "awmr/model/vehicle_file.h"

#include <fmt/format.h>

#include <span>
#include <string_view>

#include "awmr/core/column_mapping.h"
#include "awmr/core/units.h"
#include "awmr/model/ranges.h"
#include "vehicle_json.h"

namespace awmr {
namespace {

constexpr std::string_view kVehicleSchema = "awmr.vehicle/1";

/// Reads the range in which a fit may choose an exponent; returns `absent` if there is no such key.
Interval beta_range_from_json(JsonObject& json, std::string_view key, Interval absent) {
  const Interval range = json.optional_interval(key).value_or(absent);
  if (range.lo < 0.0) {
    json.fault(ErrorCode::kOutOfRange, key,
               fmt::format("with an exponent below 0, the resistance falls with speed; found "
                           "[{}, {}], give a lower end of at least 0",
                           range.lo, range.hi));
  } else if (range.hi > kExponent.max) {
    json.fault(ErrorCode::kOutOfRange, key,
               fmt::format("found [{1}, {2}], but an exponent is at most {0}; lower the upper end",
                           kExponent.max, range.lo, range.hi));
  } else if (range.lo == range.hi) {
    json.fault(ErrorCode::kWrongOrder, key,
               fmt::format("the lower end must be below the upper end, found [{}, {}]", range.lo,
                           range.hi));
  }
  return range;
}

void steering_from_json(JsonObject json, Vehicle& vehicle) {
  vehicle.steering_max_deg = json.number("max_deg", kPositive);
  if (vehicle.steering_max_deg >= 90.0) {
    json.fault(ErrorCode::kOutOfRange, "max_deg",
               fmt::format("must be below 90, found {}", vehicle.steering_max_deg));
  }
  vehicle.steering_max_rate_degps = json.number("max_rate_degps", kServoRate_degps);
  vehicle.steering_time_constant_s = json.number("time_constant_s", kServoTime_s);
  json.reject_unknown_keys();
}

/// Reads an optional number; `null` is equivalent to a missing key.
std::optional<double> known_number(JsonObject& json, std::string_view key, NumberRule rule) {
  return json.has(key) ? json.nullable_number(key, rule) : std::nullopt;
}

/// Reads the column mappings as text and checks their form. Whether a log has the columns is
/// checked when it is read.
void columns_from_json(JsonObject json, Vehicle& vehicle) {
  for (const std::string& name : json.keys()) {
    const std::string expression = json.string(name);
    if (const auto mapping = parse_column(name, expression); !mapping) {
      json.fault(name, mapping.error());
    }
    vehicle.columns[name] = expression;
  }
}

/// A property of each sensor, by its key in `noise`, `noise_correlation_s` or `latency_s`.
struct SensorKey {
  std::string_view key;
  std::optional<double> SensorQuality::*member;
};
constexpr SensorKey kNoiseKeys[] = {{"heading_deg", &SensorQuality::heading_deg},
                                    {"yaw_rate_degps", &SensorQuality::yaw_rate_degps},
                                    {"speed_mps", &SensorQuality::speed_mps},
                                    {"position_m", &SensorQuality::position_m}};
constexpr SensorKey kLatencyKeys[] = {{"heading", &SensorQuality::heading_latency_s},
                                      {"yaw_rate", &SensorQuality::yaw_rate_latency_s},
                                      {"speed", &SensorQuality::speed_latency_s},
                                      {"position", &SensorQuality::position_latency_s}};
constexpr SensorKey kCorrelationKeys[] = {{"heading", &SensorQuality::heading_correlation_s},
                                          {"yaw_rate", &SensorQuality::yaw_rate_correlation_s},
                                          {"speed", &SensorQuality::speed_correlation_s}};

void sensors_from_json(std::optional<JsonObject> json, std::span<const SensorKey> keys,
                       const NumberRule& rule, SensorQuality& sensors) {
  if (!json) return;
  for (const SensorKey& sensor : keys) {
    sensors.*sensor.member = json->optional_number(sensor.key, rule);
  }
  json->reject_unknown_keys();
}

void sensors_to_json(const SensorQuality& sensors, std::span<const SensorKey> keys,
                     const char* object, Json& json) {
  for (const SensorKey& sensor : keys) {
    if (sensors.*sensor.member) json[object][std::string(sensor.key)] = *(sensors.*sensor.member);
  }
}

void control_from_json(JsonObject& json, Vehicle& vehicle) {
  if (json.has("allocation")) vehicle.allocation = json.choice("allocation", kAllocationFormNames);
  sensors_from_json(json.optional_object("noise"), kNoiseKeys, kSensorNoise, vehicle.sensors);
  sensors_from_json(json.optional_object("noise_correlation_s"), kCorrelationKeys, kCorrelation_s,
                    vehicle.sensors);
  sensors_from_json(json.optional_object("latency_s"), kLatencyKeys, kLatency_s, vehicle.sensors);
  if (auto motor = json.optional_object("motor")) {
    vehicle.motor_time_constant_s = motor->optional_number("time_constant_s", kLatency_s);
    vehicle.back_emf_s_per_m = motor->optional_number("back_emf_s_per_m", kBackEmf_s_per_m);
    vehicle.motor_stall_power_w = motor->optional_number("stall_power_w", kStallPower_w);
    motor->reject_unknown_keys();
  }
  vehicle.yaw_rate_max_degps = json.optional_number("yaw_rate_max_degps", kFastestTurn_degps);
}

void control_to_json(const Vehicle& vehicle, Json& json) {
  if (vehicle.allocation != AllocationForm::kExact) {
    json["allocation"] = name_in(kAllocationFormNames, vehicle.allocation);
  }
  sensors_to_json(vehicle.sensors, kNoiseKeys, "noise", json);
  sensors_to_json(vehicle.sensors, kCorrelationKeys, "noise_correlation_s", json);
  sensors_to_json(vehicle.sensors, kLatencyKeys, "latency_s", json);
  if (vehicle.motor_time_constant_s) {
    json["motor"]["time_constant_s"] = *vehicle.motor_time_constant_s;
  }
  if (vehicle.back_emf_s_per_m) json["motor"]["back_emf_s_per_m"] = *vehicle.back_emf_s_per_m;
  if (vehicle.motor_stall_power_w) json["motor"]["stall_power_w"] = *vehicle.motor_stall_power_w;
  if (vehicle.yaw_rate_max_degps) json["yaw_rate_max_degps"] = *vehicle.yaw_rate_max_degps;
}

/// A unit smaller than that of the key, in which a number above its range `rule` was probably
/// given, such as mm for m. `words`: name of this unit; `factor` converts the number from this
/// unit.
struct SmallerUnit {
  std::string_view pointer;
  NumberRule rule;
  double factor;
  std::string_view words;
};
constexpr SmallerUnit kSmallerUnits[] = {{"/length_m", kSize_m, 1e-3, "mm"},
                                         {"/width_m", kSize_m, 1e-3, "mm"},
                                         {"/front_axle_m", kSize_m, 1e-3, "mm"},
                                         {"/half_track_m", kSize_m, 1e-3, "mm"},
                                         {"/sample_time_s", kSampleTime_s, 1e-3, "ms"}};

/// Adds to the message of each number above its range the smaller unit in which it was probably
/// given, and the converted number.
void name_units(const Json& document, const std::string& place, std::vector<Fault>& faults) {
  for (Fault& fault : faults) {
    for (const SmallerUnit& unit : kSmallerUnits) {
      if (fault.place != place + std::string(unit.pointer)) continue;
      const Json::json_pointer pointer{std::string(unit.pointer)};
      if (!document.contains(pointer) || !document.at(pointer).is_number()) continue;
      const double value = document.at(pointer).get<double>();
      if (value <= unit.rule.max || value * unit.factor > unit.rule.max) continue;
      fault.message +=
          fmt::format("; the number looks like {}: {:.4g}", unit.words, value * unit.factor);
    }
  }
}

/// Replaces the message of a fault about the drive `rear_wheel`, whose suggestion of the nearest
/// name would mislead.
void name_rear_wheel_drive(const Json& document, const std::string& place,
                           std::vector<Fault>& faults) {
  const Json::json_pointer pointer{"/drive"};
  if (!document.contains(pointer) || document.at(pointer) != kRearWheelDrive) return;
  for (Fault& fault : faults) {
    if (fault.place == place + "/drive") fault.message = kNoRearWheelDrive;
  }
}

}  // namespace

void explain_vehicle_faults(const Json& vehicle, const std::string& place,
                            std::vector<Fault>& faults) {
  name_units(vehicle, place, faults);
  name_rear_wheel_drive(vehicle, place, faults);
}

Vehicle vehicle_from_json(JsonObject& json) {
  Vehicle vehicle;
  json.schema(kVehicleSchema);
  vehicle.name = json.string("name");
  vehicle.mass_kg = json.number("mass_kg", kMass_kg);
  vehicle.length_m = json.number("length_m", kSize_m);
  vehicle.width_m = json.number("width_m", kSize_m);
  if (json.has("drive")) vehicle.drive = json.choice("drive", kDriveNames);
  vehicle.half_track_m = json.number("half_track_m", kSize_m);
  // The distance l_f from the centre of gravity to the front axle is optional for a vehicle without
  // steering: it only gives the position of the front wheels.
  vehicle.front_axle_m = vehicle.has_steering() || json.has("front_axle_m")
                             ? json.number("front_axle_m", kSize_m)
                             : vehicle.half_track_m;
  vehicle.wheel_force = wheel_force_from_json(json.object("wheel_force"));
  if (vehicle.has_steering()) {
    steering_from_json(json.object("steering"), vehicle);
  } else if (json.has("steering")) {
    json.fault(ErrorCode::kConflict, "steering",
               "a vehicle with drive \"differential\" has no steering; remove this key, or choose "
               "another drive");
  }
  vehicle.sample_time_s = json.number("sample_time_s", kSampleTime_s);
  vehicle.yaw_inertia_kgm2 = known_number(json, "yaw_inertia_kgm2", kYawInertia_kgm2);
  vehicle.sway_alpha = known_number(json, "sway_alpha", kCoefficient);
  vehicle.surge_beta_range =
      beta_range_from_json(json, "surge_beta_range", vehicle.surge_beta_range);
  vehicle.yaw_beta_range = beta_range_from_json(json, "yaw_beta_range", vehicle.yaw_beta_range);
  control_from_json(json, vehicle);
  if (auto columns = json.optional_object("columns")) columns_from_json(*columns, vehicle);
  json.reject_unknown_keys();
  return vehicle;
}

Interval wheel_force_from_json(JsonObject json) {
  Interval force;
  // F' is relative to the largest force of one motor, so it is within [-1, 1]. The range must
  // include 0 (motors off) and forward forces.
  force.lo = json.number("min", {.min = -1.0, .max = 0.0});
  force.hi = json.number("max", {.min = 0.0, .max = 1.0, .min_excluded = true});
  json.reject_unknown_keys();
  return force;
}

Json wheel_force_to_json(const Interval& force) { return {{"min", force.lo}, {"max", force.hi}}; }

Json vehicle_to_json(const Vehicle& vehicle) {
  Json json;
  json["schema"] = kVehicleSchema;
  json["name"] = vehicle.name;
  json["mass_kg"] = vehicle.mass_kg;
  json["length_m"] = vehicle.length_m;
  json["width_m"] = vehicle.width_m;
  if (vehicle.drive != Drive::kFourWheel) json["drive"] = name_in(kDriveNames, vehicle.drive);
  json["front_axle_m"] = vehicle.front_axle_m;
  json["half_track_m"] = vehicle.half_track_m;
  json["wheel_force"] = wheel_force_to_json(vehicle.wheel_force);
  if (vehicle.has_steering()) {
    json["steering"]["max_deg"] = vehicle.steering_max_deg;
    json["steering"]["max_rate_degps"] = vehicle.steering_max_rate_degps;
    json["steering"]["time_constant_s"] = vehicle.steering_time_constant_s;
  }
  json["sample_time_s"] = vehicle.sample_time_s;
  if (vehicle.yaw_inertia_kgm2) json["yaw_inertia_kgm2"] = *vehicle.yaw_inertia_kgm2;
  if (vehicle.sway_alpha) json["sway_alpha"] = *vehicle.sway_alpha;
  json["surge_beta_range"] = {vehicle.surge_beta_range.lo, vehicle.surge_beta_range.hi};
  json["yaw_beta_range"] = {vehicle.yaw_beta_range.lo, vehicle.yaw_beta_range.hi};
  control_to_json(vehicle, json);
  for (const auto& [name, expression] : vehicle.columns) json["columns"][name] = expression;
  return json;
}

std::string vehicle_schema() {
  return json_schema_text(kVehicleSchema, "A vehicle: data known before any trial",
                          [](JsonObject& json) { vehicle_from_json(json); });
}

Result<Vehicle> read_vehicle(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const Json json, read_json_file(path));
  std::vector<Fault> faults;
  JsonObject root(json, path.string(), "", faults);
  Vehicle vehicle = vehicle_from_json(root);
  explain_vehicle_faults(json, path.string() + ":", faults);
  if (!faults.empty()) return input_errors(std::move(faults));
  return vehicle;
}

}  // namespace awmr
