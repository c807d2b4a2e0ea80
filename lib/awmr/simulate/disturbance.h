/// Disturbances of a run as functions of time, one value per sample. Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "awmr/core/random.h"
#include "awmr/simulate/world.h"

namespace awmr {

/// Seed of a run, from which its random streams are made: one stream for each use of random
/// numbers, such as a sensor or a disturbance term.
struct RunSeed {
  std::uint64_t seed = 0;
  std::uint64_t sample = 0;  ///< number of the draw
  /// Returns the random stream for the use with the number `use`, < 1024. Bit 62 is set in the
  /// number of this stream, which distinguishes it from the streams of compare/: these have small
  /// numbers, or numbers in which bit 63 is set.
  Random random(std::uint64_t use) const {
    return {seed, (std::uint64_t{1} << 62U) | (sample << 10U) | use};
  }
};

/// The seed of a run from the scenario's seed, the seed of the simulation and the number `sample`
/// of the draw. The constant is 2^64 over the golden ratio: with it, adjacent seeds of a simulation
/// give distant seeds of a run.
inline RunSeed run_seed(std::uint64_t scenario_seed, std::uint64_t seed, std::uint64_t sample) {
  return {scenario_seed + seed * 0x9E3779B97F4A7C15U, sample};
}

/// Generates the sum of the disturbance terms of one axis, sample by sample.
class DisturbanceSource {
 public:
  /// `first_use`: number of the random stream (RunSeed::random) of the first term. The further
  /// terms use the numbers after it.
  DisturbanceSource(const std::vector<DisturbanceTerm>& terms, double sample_time_s,
                    const RunSeed& seed, std::uint64_t first_use);
  /// The sum over the sample that begins at `t_s`, in the unit of the terms. Call it once per
  /// sample, in order.
  double next(double t_s);

 private:
  struct Running {
    DisturbanceTerm term;
    Random random;
    double phase_rad = 0.0;
    double keep = 0.0;   ///< c of the low pass: factor over one sample
    double value = 0.0;  ///< state of the low pass
  };
  std::vector<Running> terms_;
};

/// The disturbance of a run in surge, sway and yaw.
class RunDisturbance {
 public:
  RunDisturbance(const Disturbance& disturbance, double sample_time_s, const RunSeed& seed);
  /// Forces and moment over the sample that begins at `t_s`, without those of a slope. Call it once
  /// per sample, in order.
  BodyLoad next(double t_s) { return {surge_.next(t_s), sway_.next(t_s), yaw_.next(t_s)}; }

 private:
  DisturbanceSource surge_, sway_, yaw_;
};

}  // namespace awmr
