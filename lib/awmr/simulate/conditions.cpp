#include "awmr/simulate/conditions.h"

#include "awmr/core/units.h"

namespace awmr {

LoopConditions conditions_of(const Vehicle& vehicle) {
  const SensorQuality& sensors = vehicle.sensors;
  LoopConditions c;
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

}  // namespace awmr
