/// Disturbances over time, one value per sample. Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "awmr/core/random.h"
#include "awmr/simulate/world.h"

namespace awmr {

/// Random streams of a run: one per use, independent of the others.
struct RunSeed {
  std::uint64_t seed = 0;
  std::uint64_t sample = 0;
  /// `use` < 1024. Different from the streams of compare/, which are small numbers and those with
  /// bit 63.
  Random random(std::uint64_t use) const {
    return {seed, (std::uint64_t{1} << 62U) | (sample << 10U) | use};
  }
};

/// Combines two seeds. (The odd constant is 2^64 over the golden ratio, so that adjacent seeds give
/// distant results.)
inline RunSeed run_seed(std::uint64_t scenario_seed, std::uint64_t seed, std::uint64_t sample) {
  return {scenario_seed + seed * 0x9E3779B97F4A7C15U, sample};
}

/// The sum of one axis's terms, sample by sample.
class DisturbanceSource {
 public:
  /// `first_use`: of RunSeed::random, one per term.
  DisturbanceSource(const std::vector<DisturbanceTerm>& terms, double sample_time_s,
                    const RunSeed& seed, std::uint64_t first_use);
  /// The value over the sample that begins at `t_s`; call it once per sample, in order.
  double next(double t_s);

 private:
  struct Running {
    DisturbanceTerm term;
    Random random;
    double phase_rad = 0.0;
    double keep = 0.0;   ///< of the low pass, over one sample
    double value = 0.0;  ///< of the low pass
  };
  std::vector<Running> terms_;
};

/// The disturbance of a run along all axes.
class RunDisturbance {
 public:
  RunDisturbance(const Disturbance& disturbance, double sample_time_s, const RunSeed& seed);
  /// Over the sample that begins at `t_s`, without the slope's share; call it once per sample, in
  /// order.
  BodyLoad next(double t_s) { return {surge_.next(t_s), sway_.next(t_s), yaw_.next(t_s)}; }

 private:
  DisturbanceSource surge_, sway_, yaw_;
};

}  // namespace awmr
