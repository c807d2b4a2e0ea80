/// Trade-off front of settling time and control variation, found by a simulator and a search that
/// share no code with lib/awmr.
#pragma once

#include <cstdint>
#include <vector>

#include "peers/trade_off/gain_limits.h"
#include "peers/trade_off/heading_simulator.h"

namespace awmr::peers {

/// Inputs of the search: the model that the controller knows, the vehicle, its sensors and limits,
/// and the courses (sequences of heading commands).
struct Case {
  Body model;
  Geometry vehicle;
  SensorErrors errors;
  std::vector<Mode> modes;
  std::vector<Course> courses;
  Limits limits;
  Examined examined;
  std::vector<Body> limit_bodies;  ///< bodies that must meet the limits in addition to the model
};

/// A body (masses and resistances of a vehicle), with the sensor noise of its run on each course.
struct Trial {
  Body body;
  std::vector<Noise> noise;
};
std::vector<Trial> with_noise(const Case& one, const std::vector<Body>& bodies, std::uint64_t seed);

/// Metrics averaged over trials, modes and courses.
struct Means {
  double settling_s = 0.0, variation = 0.0, overshoot_deg = 0.0, steering_rms_degps = 0.0,
         speed_itae_ms = 0.0;
};
Means means_of(const Case& one, const std::vector<Trial>& trials, const Controls& controls,
               double step_s = 2e-3);

struct FrontOptions {
  int scattered = 240;  ///< number of log-uniform random gains within the limits that are simulated
  int rounds = 8;       ///< generations of the evolution strategy
  int offspring = 20;   ///< gains per generation
  std::uint64_t seed = 1;
};

/// Finds the gains with the shortest settling time that meet every limit and whose control variation,
/// overshoot and error of the speed (ITAE) on the trials are at most those of `most`. Draws
/// gains within a factor of 30 of `near` (speed gains: 5), then refines the best few and `near` by
/// an evolution strategy.
LawGains least_settling(const Case& one, const std::vector<Trial>& trials, const LawGains& near,
                        FedForward fed_forward, const Means& most,
                        const FrontOptions& options = {});

}  // namespace awmr::peers
