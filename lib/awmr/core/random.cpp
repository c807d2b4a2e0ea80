#include "awmr/core/random.h"

#include <Random123/philox.h>

#include <cmath>

#include "awmr/core/units.h"

namespace awmr {

Random::Random(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}

std::uint32_t Random::bits() {
  if (left_ == 0) {
    const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
    const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32U); };
    const r123::Philox4x32::ctr_type counter = {
        {low(counter_), high(counter_), low(stream_), high(stream_)}};
    const r123::Philox4x32::key_type key = {{low(seed_), high(seed_)}};
    const auto block = r123::Philox4x32()(counter, key);
    for (unsigned i = 0; i < 4; ++i) block_[i] = block[i];
    ++counter_;
    left_ = 4;
  }
  --left_;
  return block_[3 - left_];
}

double Random::uniform() {
  const std::uint64_t high = bits() >> 5U;
  const std::uint64_t low = bits() >> 6U;
  return static_cast<double>((high << 26U) | low) * 0x1.0p-53;
}

double Random::normal() {
  // Box-Muller method: sqrt(-2 ln U1) cos(2 pi U2), U1 in (0, 1]
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * pi<double>() * uniform());
}

}  // namespace awmr
