/// Independent trade-off front of settling time against command activity.
#pragma once

#include <cstdint>
#include <vector>

#include "peers/trade_off/gain_limits.h"
#include "peers/trade_off/heading_simulator.h"

namespace awmr::peers {

/// A vehicle with what is known of it, and what it is driven on.
struct Case {
  Body model;
  Geometry vehicle;
  SensorErrors errors;
  std::vector<Mode> modes;
  std::vector<Course> courses;
  Limits limits;
  Examined examined;
  std::vector<Body> limit_bodies;  ///< for which the limits have to hold, in addition to the model
};

/// Bodies with the noise of their runs, by course.
struct Trial {
  Body body;
  std::vector<Noise> noise;
};
std::vector<Trial> with_noise(const Case& one, const std::vector<Body>& bodies, std::uint64_t seed);

/// Means over trials, modes and courses.
struct Means {
  double settling_s = 0.0, variation = 0.0, overshoot_deg = 0.0, steering_rms_degps = 0.0;
};
Means means_of(const Case& one, const std::vector<Trial>& trials, const Controls& controls,
               double step_s = 2e-3);

struct FrontOptions {
  int scattered = 240;  ///< admissible gains that are driven, log-uniform
  int rounds = 8;       ///< of refinement
  int offspring = 20;   ///< of a round
  std::uint64_t seed = 1;
};

/// The gains with the least settling time of those that keep every limit and are no more active than
/// `most_variation`, nor overshoot more, on the trials: scattered over a factor of 30 either side of `near`
/// (speed gains: 5), then refined by an evolution strategy from the best few and from `near`.
LawGains least_settling(const Case& one, const std::vector<Trial>& trials, const LawGains& near,
                        FedForward fed_forward, double most_variation, double most_overshoot_deg,
                        const FrontOptions& options = {});

}  // namespace awmr::peers
