#include "awmr/simulate/conditions.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "awmr/core/units.h"

namespace awmr {
namespace {

/// True if the readings of all sensors are exact. Without noise, its correlation has no effect.
bool has_exact_sensors(const LoopConditions& c) {
  return c.heading_noise_deg == 0.0 && c.yaw_rate_noise_degps == 0.0 && c.speed_noise_mps == 0.0 &&
         c.heading_latency_s == 0.0 && c.yaw_rate_latency_s == 0.0 && c.speed_latency_s == 0.0;
}

}  // namespace

LoopConditions conditions_of(const Vehicle& vehicle, const LoopConditions& missing) {
  const SensorQuality& sensors = vehicle.sensors;
  LoopConditions c = missing;
  c.heading_noise_deg = sensors.heading_deg.value_or(c.heading_noise_deg);
  c.yaw_rate_noise_degps = sensors.yaw_rate_degps.value_or(c.yaw_rate_noise_degps);
  c.speed_noise_mps = sensors.speed_mps.value_or(c.speed_noise_mps);
  c.heading_correlation_s = sensors.heading_correlation_s.value_or(c.heading_correlation_s);
  c.yaw_rate_correlation_s = sensors.yaw_rate_correlation_s.value_or(c.yaw_rate_correlation_s);
  c.speed_correlation_s = sensors.speed_correlation_s.value_or(c.speed_correlation_s);
  c.heading_latency_s = sensors.heading_latency_s.value_or(c.heading_latency_s);
  c.yaw_rate_latency_s = sensors.yaw_rate_latency_s.value_or(c.yaw_rate_latency_s);
  c.speed_latency_s = sensors.speed_latency_s.value_or(c.speed_latency_s);
  c.motor_time_constant_s = vehicle.motor_time_constant_s.value_or(c.motor_time_constant_s);
  return c;
}

LoopConditions conditions_of(const Scenario& scenario) {
  const Sensors sensors = scenario.sensors.value_or(Sensors{});
  const Actuators actuators = scenario.actuators.value_or(Actuators{});
  return {.heading_noise_deg = degrees(sensors.heading.noise),
          .yaw_rate_noise_degps = degrees(sensors.yaw_rate.noise),
          .speed_noise_mps = sensors.speed.noise,
          .heading_correlation_s = sensors.heading.correlation_s,
          .yaw_rate_correlation_s = sensors.yaw_rate.correlation_s,
          .speed_correlation_s = sensors.speed.correlation_s,
          .heading_latency_s = sensors.heading.latency_s,
          .yaw_rate_latency_s = sensors.yaw_rate.latency_s,
          .speed_latency_s = sensors.speed.latency_s,
          .motor_time_constant_s = actuators.motor_time_constant_s};
}

Scenario under(const LoopConditions& c, Scenario scenario) {
  const auto channel = [](double noise, double latency_s, double correlation_s) {
    return Channel{.noise = noise, .latency_s = latency_s, .correlation_s = correlation_s};
  };
  if (!scenario.sensors) {
    scenario.sensors =
        Sensors{.heading = channel(radians(c.heading_noise_deg), c.heading_latency_s,
                                   c.heading_correlation_s),
                .yaw_rate = channel(radians(c.yaw_rate_noise_degps), c.yaw_rate_latency_s,
                                    c.yaw_rate_correlation_s),
                .speed = channel(c.speed_noise_mps, c.speed_latency_s, c.speed_correlation_s),
                .gps = {}};
  }
  if (!scenario.actuators) {
    scenario.actuators = Actuators{.motor_time_constant_s = c.motor_time_constant_s};
  }
  return scenario;
}

Scenario equipped(const Vehicle& vehicle, Scenario scenario) {
  const LoopConditions given = conditions_of(vehicle, kIdealConditions);
  const bool has_sensors = scenario.sensors.has_value();
  const bool has_actuators = scenario.actuators.has_value();
  scenario = under(given, std::move(scenario));
  // Exact sensors and motors without lag are not added, because a scenario without these keys means
  // the same.
  const bool needs_no_sensors =
      has_exact_sensors(given) || std::holds_alternative<OpenLoop>(scenario.guidance);
  if (!has_sensors && needs_no_sensors) scenario.sensors.reset();
  if (!has_actuators && given.motor_time_constant_s == 0.0) scenario.actuators.reset();
  return scenario;
}

std::vector<Scenario> equipped(const Vehicle& vehicle, std::vector<Scenario> scenarios) {
  for (Scenario& scenario : scenarios) scenario = equipped(vehicle, std::move(scenario));
  return scenarios;
}

namespace {

/// Text such as "heading: noise 0.5 deg, latency 0.01 s".
std::string sensor_text(const char* name, double noise, const char* unit, double latency_s) {
  std::string text = name;
  text += noise > 0.0 ? fmt::format(": noise {:g} {}", noise, unit) : ": no noise";
  return text + (latency_s > 0.0 ? fmt::format(", latency {:g} s", latency_s) : ", no latency");
}

}  // namespace

std::string equipment_text(const Vehicle& vehicle, std::span<const Scenario> as_given) {
  bool adds_sensors = false;
  bool adds_motors = false;
  for (const Scenario& scenario : as_given) {
    const Scenario with = equipped(vehicle, scenario);
    adds_sensors = adds_sensors || with.sensors.has_value() != scenario.sensors.has_value();
    adds_motors = adds_motors || with.actuators.has_value() != scenario.actuators.has_value();
  }
  const LoopConditions c = conditions_of(vehicle, kIdealConditions);
  std::string text;
  if (adds_sensors) {
    text += fmt::format(
        "sensors of vehicle.json, in scenarios without the key sensors:\n  {}; {}; {}\n",
        sensor_text("heading", c.heading_noise_deg, "deg", c.heading_latency_s),
        sensor_text("yaw rate", c.yaw_rate_noise_degps, "deg/s", c.yaw_rate_latency_s),
        sensor_text("speed", c.speed_noise_mps, "m/s", c.speed_latency_s));
  }
  if (adds_motors) {
    text += fmt::format(
        "motors of vehicle.json, in scenarios without the key actuators: time constant {:g} s\n",
        c.motor_time_constant_s);
  }
  return text;
}

}  // namespace awmr
