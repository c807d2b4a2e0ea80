/// Counter-based random numbers (Philox 4x32-10): the n-th number of a stream depends on seed,
/// stream and n alone, so results do not depend on threads or order.
#pragma once

#include <cstdint>

namespace awmr {

/// One stream of numbers.
class Random {
 public:
  /// The streams of a seed are independent of each other. Whatever is random on its own takes its
  /// own stream: each sample, each sensor.
  Random(std::uint64_t seed, std::uint64_t stream);

  /// The next 32 random bits.
  std::uint32_t bits();
  /// The next number, uniform in [0, 1), with 53 random bits.
  double uniform();
  /// The next number, normal with mean 0 and standard deviation 1. It takes two uniform ones and
  /// uses one half of what the Box-Muller method makes of them, so that the place in the stream
  /// depends only on how many numbers were drawn.
  double normal();

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t counter_ = 0;
  std::uint32_t block_[4] = {};
  int left_ = 0;
};

}  // namespace awmr
