/// Generator of random doubles for RapidCheck.
#pragma once

#include <rapidcheck.h>

#include <bit>
#include <cstdint>

namespace awmr::testing {

/// Generates any finite double from sign, exponent and mantissa: all magnitudes, subnormals, both
/// zeros.
inline rc::Gen<double> any_finite() {
  // At sizes below the nominal one, RapidCheck draws only from a part of the range.
  return rc::gen::resize(
      rc::kNominalSize,
      rc::gen::map(
          rc::gen::tuple(rc::gen::arbitrary<bool>(), rc::gen::inRange<std::uint64_t>(0, 2047),
                         rc::gen::inRange<std::uint64_t>(0, std::uint64_t{1} << 52U)),
          [](const std::tuple<bool, std::uint64_t, std::uint64_t>& parts) {
            const auto& [is_negative, exponent, fraction] = parts;
            const std::uint64_t sign = is_negative ? 1 : 0;
            return std::bit_cast<double>(sign << 63U | exponent << 52U | fraction);
          }));
}

}  // namespace awmr::testing
