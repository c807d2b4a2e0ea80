/// Logs of a simulated robot with known truth.
#pragma once

#include <cstdint>

#include "awmr/identify/planning/synthetic.h"
#include "identify/synthetic.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {

inline Vehicle robot() {
  Vehicle v = paper_vehicle();
  v.name = "synthetic";
  v.yaw_inertia_kgm2.reset();  // the box formula
  v.sway_alpha.reset();        // to be estimated from the log
  return v;
}

inline Plant<double> plant(const Truth& t) {
  Plant<double> plant = paper_plant();
  plant.surge = {.alpha = t.a1, .beta = t.b1};
  plant.yaw = {.alpha = t.a3, .beta = t.b3};
  plant.mass_norm = t.mass_norm;
  plant.inertia_norm = 0.16 * t.mass_norm;
  return plant;
}

inline DrivingLog drive(const Truth& t, std::uint64_t seed, DrivePlan plan = {.duration_s = 20.0},
                        const SensorNoise& noise = {}) {
  Random random(seed, 5);
  plan.drive = seed;
  return simulate_log(plant(t), robot(), plan, noise, random);
}

/// Sensors with 1/sqrt(2) of the default noise. A log of 20 s then shows as much as one of 40 s with
/// the default noise, and is fitted in half the time. So is a log with half the rows.
inline constexpr SensorNoise kPreciseSensors{
    .speed_mps = 0.0141, .yaw_rate_radps = 0.00617, .heading_rad = 0.01234, .position_m = 0.0354};

/// Sensors with half of the default noise, for short logs of errors that are found by their size.
inline constexpr SensorNoise kVeryPreciseSensors{
    .speed_mps = 0.01, .yaw_rate_radps = 0.00436, .heading_rad = 0.00873, .position_m = 0.025};

}  // namespace awmr::testing
