/// Parses common decimal numbers to the nearest double, identical to std::from_chars, which parses
/// the others. Private to the library.
///
/// A number  m / 10^e  with integer  m < 2^53  and  e <= 22  needs one division: m and 10^e are
/// exact doubles, and the division rounds once.
/// [Clinger, How to Read Floating Point Numbers Accurately, 1990]
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace awmr {

inline constexpr double kPowersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                          1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                          1e14, 1e15, 1e16, 1e17, 1e18, 1e19};
inline constexpr std::uint64_t kWholePowersOfTen[] = {1,     10,     100,     1000,
                                                      10000, 100000, 1000000, 10000000};

/// Value of eight digits stored as bytes 0 ... 9 of a word, the first in the lowest byte: combines
/// pairs, then fours, then all eight, each with one multiplication.
inline std::uint64_t number_of_eight(std::uint64_t digits) {
  constexpr std::uint64_t kMask = 0x000000FF000000FFU;
  digits = digits * 10 + (digits >> 8U);  // byte 0: 10 d0 + d1, byte 2: 10 d2 + d3 ...
  return ((digits & kMask) * (100 + (1000000ULL << 32U)) +
          ((digits >> 16U) & kMask) * (1 + (10000ULL << 32U))) >>
         32U;
}

/// Appends the digits at `text` to `number`; returns their end. Eight bytes behind them must be
/// readable. From the 20th digit on, `number` is undefined.
inline const char* take_digits(const char* text, std::uint64_t& number) {
  if constexpr (std::endian::native == std::endian::little) {
    while (true) {
      std::uint64_t bytes = 0;
      std::memcpy(&bytes, text, sizeof(bytes));
      const std::uint64_t digits = bytes ^ 0x3030303030303030U;
      // Top bit of each byte above 9. A carry reaches only bytes behind such a byte.
      const std::uint64_t others = ((digits + 0x7676767676767676U) | digits) & 0x8080808080808080U;
      if (others != 0) {
        const auto count = static_cast<unsigned>(std::countr_zero(others)) / 8;
        const unsigned half = 32 - 4 * count;  // in two steps: a word cannot be shifted by 64
        number = number * kWholePowersOfTen[count] + number_of_eight(digits << half << half);
        return text + count;
      }
      number = number * 100000000 + number_of_eight(digits);
      text += 8;
    }
  } else {
    for (; *text >= '0' && *text <= '9'; ++text) {
      number = 10 * number + static_cast<std::uint64_t>(*text - '0');
    }
    return text;
  }
}

/// Parses a number like `-12.5`, without an exponent and short enough for one division. Returns its
/// end, or null. Precondition: eight bytes behind it are readable.
inline const char* take_exact_number(const char* text, double& value) {
  constexpr std::ptrdiff_t kMostDigits = 19;  // of 64 bits
  const bool is_negative = *text == '-';
  if (is_negative) ++text;
  const char* const first = text;
  std::uint64_t mantissa = 0;
  // Few digits precede the point, as many as in the row above, so the branches of a plain loop are
  // predictable.
  for (unsigned digit = 0; (digit = static_cast<unsigned char>(*text - '0')) <= 9; ++text) {
    mantissa = 10 * mantissa + digit;
  }
  std::ptrdiff_t digits = text - first;
  std::ptrdiff_t decimals = 0;
  if (*text == '.') {
    const char* const fraction = ++text;
    text = take_digits(text, mantissa);
    decimals = text - fraction;
    digits += decimals;
  }
  if (digits == 0 || digits > kMostDigits || mantissa >> 53U != 0) return nullptr;
  const double size =
      static_cast<double>(static_cast<std::int64_t>(mantissa)) / kPowersOfTen[decimals];
  value = is_negative ? -size : size;
  return text;
}

}  // namespace awmr
