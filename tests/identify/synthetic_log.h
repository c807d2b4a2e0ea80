/// Logs of a simulated robot with known truth.
#pragma once

#include <cstdint>
#include <vector>

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

/// Removes position and heading.
inline void remove_pose(DrivingLog& log) {
  for (const LogChannel c : {LogChannel::kX, LogChannel::kY, LogChannel::kHeading}) log[c].reset();
}

/// Sensors with 1/sqrt(2) of the default noise. A log of 20 s then shows as much as one of 40 s with
/// the default noise, and is fitted in half the time. So is a log with half the rows.
inline constexpr SensorNoise kPreciseSensors{
    .speed_mps = 0.0141, .yaw_rate_radps = 0.00617, .heading_rad = 0.01234, .position_m = 0.0354};

/// Sensors with half of the default noise, for short logs of errors that are found by their size.
inline constexpr SensorNoise kVeryPreciseSensors{
    .speed_mps = 0.01, .yaw_rate_radps = 0.00436, .heading_rad = 0.00873, .position_m = 0.025};

/// Sensors with 0.35 of the default noise, for the shortest logs.
inline constexpr SensorNoise kMostPreciseSensors{
    .speed_mps = 0.007, .yaw_rate_radps = 0.0031, .heading_rad = 0.0061, .position_m = 0.0175};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// A log with a change of the vehicle: a drive of `first_s` seconds of the vehicle `truth`, a pause
/// in the recording, and a drive of `last_s` seconds of the vehicle `changed`.
inline DrivingLog log_with_change(const Truth& truth, const Truth& changed, double first_s,
                                  double last_s, std::uint64_t seed) {
  constexpr double kPause_s = 2.0;
  DrivingLog log = drive(truth, seed, {.duration_s = first_s, .rate_hz = 50.0}, kPreciseSensors);
  DrivingLog last =
      drive(changed, seed + 100, {.duration_s = last_s, .rate_hz = 50.0}, kPreciseSensors);
  for (double& t_s : last.t_s) t_s += log.t_s.back() + kPause_s;
  for (int& line : last.line) line += log.line.back();
  append(log.t_s, last.t_s);
  append(log.line, last.line);
  append(log.force_left, last.force_left);
  append(log.force_right, last.force_right);
  append(*log.steering_command_rad, *last.steering_command_rad);
  for (std::size_t c = 0; c < kChannelCount; ++c) {
    if (!log.measured[c]) continue;
    append(log.measured[c]->value, last.measured[c]->value);
    log.measured[c]->fresh.insert(log.measured[c]->fresh.end(), last.measured[c]->fresh.begin(),
                                  last.measured[c]->fresh.end());
    log.measured[c]->fresh_count += last.measured[c]->fresh_count;
  }
  return log;
}

}  // namespace awmr::testing
