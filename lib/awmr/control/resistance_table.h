/// A resistance as a table: what the chip uses instead of powf. Freestanding C++14.
///
/// The entries lie at the speeds that a float's exponent and its leading m mantissa bits name: 2^m
/// of them to an octave, evenly spaced in it. So the error follows the curve's own scale, and an
/// index is a shift of the float's bits, without a logarithm. Between two entries the curve is
/// their chord, and below the first entry the chord to the origin. It is odd: g(-w) = -g(w).
#pragma once

#include <stdint.h>

#include "awmr/control/flash.h"
#include "awmr/model/float_math.h"

namespace awmr {

/// A view of a table: the values are not owned.
struct ResistanceTable {
  const float* values;    ///< g at the entries, in its own unit, ascending; in flash on an AVR
  uint16_t count;         ///< of entries, >= 2
  uint16_t first;         ///< cell_of() of the first entry's speed
  uint8_t mantissa_bits;  ///< m, in [0, 7]
  float slope_at_rest;    ///< g(w)/w at the first entry

  /// The exponent and the leading mantissa bits of a magnitude, as one number.
  static uint16_t cell_of(uint32_t magnitude_bits, uint8_t mantissa_bits) {
    return static_cast<uint16_t>(static_cast<uint16_t>(magnitude_bits >> 16U) >>
                                 (7U - mantissa_bits));
  }

  /// g(speed), speed in m/s or rad/s. Beyond the last entry and for NaN the result is NaN: a caller
  /// checks the range first.
  float operator()(const float& speed) const {
    const uint32_t magnitude = float_math::magnitude_bits(speed);
    const uint16_t cell = cell_of(magnitude, mantissa_bits);
    if (cell < first) return slope_at_rest * speed;
    const uint16_t index = static_cast<uint16_t>(cell - first);
    if (index + 1 >= count) return float_math::not_a_number();
    const float low = flash_float(values + index);
    const float high = flash_float(values + index + 1);
    // The mantissa's other bits tell the place t in [0, 1) inside the cell; as the mantissa of a
    // float between 1 and 2 they make 1 + t, without rounding.
    const float one_plus_t = float_of(((magnitude << mantissa_bits) & 0x007FFFFFUL) | 0x3F800000UL);
    const float value = low + (one_plus_t - 1.0F) * (high - low);
    return bits_of(speed) >> 31U != 0 ? -value : value;
  }
};

}  // namespace awmr
