/// Counter-based random numbers (Philox 4x32-10): the n-th number of a stream depends only on seed,
/// stream and n, so results do not depend on threads or order.
#pragma once

#include <cstdint>

namespace awmr {

/// One stream of numbers.
class Random {
 public:
  /// Streams of one seed are independent. Each independent random quantity (each sample, each
  /// sensor) uses its own stream.
  Random(std::uint64_t seed, std::uint64_t stream);

  /// The next 32 random bits.
  std::uint32_t bits();
  /// The next number, uniform in [0, 1), with 53 random bits.
  double uniform();
  /// The next number, normal with mean 0 and standard deviation 1. Uses two uniform numbers and
  /// only one output of the Box-Muller method, so that the stream position depends only on the
  /// number of draws.
  double normal();

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t counter_ = 0;
  std::uint32_t block_[4] = {};
  int left_ = 0;
};

}  // namespace awmr
