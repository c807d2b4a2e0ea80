/// Counter-based random numbers (Philox 4x32-10). The n-th number of a stream depends only on the
/// seed, the stream and n, so results do not depend on threads or on the order of work.
#pragma once

#include <cstdint>

namespace awmr {

/// One stream of random numbers.
class Random {
 public:
  /// Streams with the same seed and different `stream` are independent. Use one stream for each
  /// independent random quantity, such as a sensor.
  Random(std::uint64_t seed, std::uint64_t stream);

  /// The next 32 random bits.
  std::uint32_t bits();
  /// The next number, uniform in [0, 1), with 53 random bits.
  double uniform();
  /// The next number, normal with mean 0 and standard deviation 1. Consumes two uniform numbers in
  /// each call (Box-Muller method, whose second output is not used).
  double normal();

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
  std::uint64_t counter_ = 0;
  std::uint32_t block_[4] = {};
  int left_ = 0;
};

}  // namespace awmr
