/// Sensor noise, sensor latency and motor lag for the simulations in which gains are tuned. They
/// are not part of the identified model.
#pragma once

#include "awmr/model/vehicle.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Noise and latency of the sensors, and lag of the motors. vehicle.json can give these values
/// (keys `noise`, `noise_correlation_s`, `latency_s`, `motor`). A noise is a standard deviation.
/// The defaults are typical of a compass, a MEMS gyroscope and a coarse encoder with 20 ms of
/// latency each, and of small brushed motors.
struct LoopConditions {
  double heading_noise_deg = 1.0;
  double yaw_rate_noise_degps = 0.5;
  double speed_noise_mps = 0.02;
  double heading_correlation_s = 0.0;
  double yaw_rate_correlation_s = 0.0;
  double speed_correlation_s = 0.0;
  double heading_latency_s = 0.02;
  double yaw_rate_latency_s = 0.02;
  double speed_latency_s = 0.02;
  double motor_time_constant_s = 0.02;
};

/// Returns the conditions that vehicle.json gives. A missing condition has its default.
LoopConditions conditions_of(const Vehicle& vehicle);

/// Returns the scenario with sensors and actuators that have these conditions. Sensors or actuators
/// that the scenario already has are kept unchanged.
Scenario under(const LoopConditions& conditions, Scenario scenario);

}  // namespace awmr
