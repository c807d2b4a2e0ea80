/// Sensor noise, sensor latency and motor lag of simulated runs, which are not part of the
/// identified model.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/model/vehicle.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Noise (standard deviation) and latency of the sensors, and lag of the motors. vehicle.json can
/// give these values (keys `noise`, `noise_correlation_s`, `latency_s`, `motor`). The defaults are
/// typical of a compass, a MEMS gyroscope and a coarse encoder with 20 ms of latency each, and of
/// small brushed motors.
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

  friend bool operator==(const LoopConditions&, const LoopConditions&) = default;
};

/// Exact sensors without latency, and motors without lag.
inline constexpr LoopConditions kIdealConditions{.heading_noise_deg = 0.0,
                                                 .yaw_rate_noise_degps = 0.0,
                                                 .speed_noise_mps = 0.0,
                                                 .heading_latency_s = 0.0,
                                                 .yaw_rate_latency_s = 0.0,
                                                 .speed_latency_s = 0.0,
                                                 .motor_time_constant_s = 0.0};

/// Returns the conditions that vehicle.json gives, completed by those of `missing`.
LoopConditions conditions_of(const Vehicle& vehicle, const LoopConditions& missing = {});

/// Returns the conditions of a scenario. Sensors or motors that the scenario does not describe are
/// ideal.
LoopConditions conditions_of(const Scenario& scenario);

/// Adds sensors and actuators with these conditions to the scenario, unless it already has sensors
/// or actuators.
Scenario under(const LoopConditions& conditions, Scenario scenario);

/// Adds the noise, latency and lag of vehicle.json to the scenario; values that vehicle.json lacks
/// are ideal (kIdealConditions). Sensors or actuators of the scenario stay unchanged, and an
/// open-loop scenario gets no sensors. A second call changes nothing.
Scenario equipped(const Vehicle& vehicle, Scenario scenario);
std::vector<Scenario> equipped(const Vehicle& vehicle, std::vector<Scenario> scenarios);

/// Describes, for printing, the sensors and motors that equipped() adds to the scenarios; empty if
/// it adds none.
std::string equipment_text(const Vehicle& vehicle, std::span<const Scenario> as_given);

}  // namespace awmr
