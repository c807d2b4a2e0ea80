/// Disturbances of a run as functions of time, one value per sample. Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "awmr/core/random.h"
#include "awmr/simulate/world.h"

namespace awmr {

/// Seed of a run. Each use of random numbers, such as a sensor or a term of a disturbance, has its
/// own random stream, so that one use does not change the numbers of another.
struct RunSeed {
  std::uint64_t seed = 0;
  std::uint64_t sample = 0;  ///< number of the draw
  /// Returns the random stream for the use with the number `use`, < 1024. Bit 62 of the stream
  /// number is set; the streams of compare/ have small numbers or bit 63 set, so no stream is used
  /// twice.
  Random random(std::uint64_t use) const {
    return {seed, (std::uint64_t{1} << 62U) | (sample << 10U) | use};
  }
};

/// Computes the seed of a run from the scenario's seed, the seed of the simulation, and the number
/// `sample` of the Monte-Carlo draw. The factor, 2^64 divided by the golden ratio, puts the run
/// seeds of adjacent simulation seeds far apart.
inline RunSeed run_seed(std::uint64_t scenario_seed, std::uint64_t seed, std::uint64_t sample) {
  return {scenario_seed + seed * 0x9E3779B97F4A7C15U, sample};
}

/// Generates the disturbance of one axis, sample by sample: the sum of its terms.
class DisturbanceSource {
 public:
  /// The first term uses the random stream with the number `first_use` (RunSeed::random()), the
  /// next terms the numbers after it.
  DisturbanceSource(const std::vector<DisturbanceTerm>& terms, double sample_time_s,
                    const RunSeed& seed, std::uint64_t first_use);
  /// Returns the sum of the terms over the sample that begins at `t_s`, in the unit of the terms.
  /// Call it once per sample, in order.
  double next(double t_s);

 private:
  struct Running {
    DisturbanceTerm term;
    Random random;
    double phase_rad = 0.0;
    double keep = 0.0;   ///< c: factor by which the low pass keeps its old value over one sample
    double value = 0.0;  ///< state of the low pass
  };
  std::vector<Running> terms_;
};

/// The disturbance of a run in surge, sway and yaw.
class RunDisturbance {
 public:
  RunDisturbance(const Disturbance& disturbance, double sample_time_s, const RunSeed& seed);
  /// Returns forces and moment, without the force of a slope, over the sample that begins at `t_s`.
  /// Call it once per sample, in order.
  BodyLoad next(double t_s) { return {surge_.next(t_s), sway_.next(t_s), yaw_.next(t_s)}; }

 private:
  DisturbanceSource surge_, sway_, yaw_;
};

}  // namespace awmr
