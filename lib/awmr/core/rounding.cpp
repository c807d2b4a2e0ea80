#include "awmr/core/rounding.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "awmr/core/hash.h"

namespace awmr {

std::string rounding_of_functions() {
  std::string bits;
  const auto note = [&bits](double value) {
    bits += fmt::format("{:x} ", std::bit_cast<std::uint64_t>(value));
  };
  // Two variants of a function in the C library differ in the last bit for about one argument in a
  // thousand. So 4000 arguments suffice to detect a difference.
  constexpr int kArguments = 4000;
  for (int i = 1; i <= kArguments; ++i) {
    const double x = 0.00271828 * i;
    for (const double value : {std::exp(x), std::log(x), std::pow(x, 0.8841), std::sin(x),
                               std::cos(x), std::tan(x), std::atan(x)}) {
      note(value);
    }
  }
  constexpr std::size_t kDigits = 16;
  return sha256_hex(bits).substr(0, kDigits);
}

}  // namespace awmr
