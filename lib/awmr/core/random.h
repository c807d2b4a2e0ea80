/// Counter-based random numbers (Philox 4x32-10): the n-th number of a stream depends on seed,
/// stream and n alone, so results do not depend on threads or order.
#pragma once

#include <cstdint>

namespace awmr {

class Random {
 public:
  /// Streams of one seed are independent: one per sample, per sensor, ...
  Random(std::uint64_t seed, std::uint64_t stream);

  std::uint32_t bits();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Standard normal (Box-Muller; one number per two draws, so position depends on the count
  /// alone).
  double normal();

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t counter_ = 0;
  std::uint32_t block_[4] = {};
  int left_ = 0;
};

}  // namespace awmr
