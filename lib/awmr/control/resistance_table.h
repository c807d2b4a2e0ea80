/// Resistance as a table, which replaces powf on the chip. Freestanding C++14.
///
/// A cell contains the speeds with the same float exponent and leading m mantissa bits: 2^m cells
/// per octave, evenly spaced in the octave. So the relative error is similar at all speeds, and the
/// index of a cell is computed by a shift of the float's bits, without a logarithm. Within a cell,
/// the table gives the straight line (chord) through the curve's points at both ends of the cell:
/// one multiplication and one addition. Below the first cell, it gives the line from the origin to
/// the start of this cell. The table is odd: g(-w) = -g(w).
#pragma once

#include <stdint.h>

#include "awmr/control/flash.h"
#include "awmr/model/float_math.h"

namespace awmr {

/// The resistance g(w) = offset + slope w at the speeds w >= 0 of a cell. The struct has no
/// padding, so that a check sum can cover it.
struct ResistanceLine {
  float slope;   ///< in the unit of g over that of w
  float offset;  ///< in the unit of g
};

/// A view of a table: the lines are not owned.
struct ResistanceTable {
  /// In flash on an AVR. The first line is for the speeds below all cells, with offset 0; then
  /// comes one line per cell, in ascending order of speed.
  const ResistanceLine* lines;
  uint16_t count;         ///< number of lines, >= 2
  uint16_t first;         ///< cell_of() of the speeds in the first cell, lines[1]
  uint8_t mantissa_bits;  ///< m, in [0, 7]

  /// Number of the cell of a speed: exponent and leading mantissa bits of the float, without sign.
  static uint16_t cell_of(float speed, uint8_t mantissa_bits) {
    return static_cast<uint16_t>(float_math::leading_bits(speed) >> (7U - mantissa_bits));
  }

  /// g(speed), speed in m/s or rad/s. Beyond the last cell and for NaN the result is NaN: the
  /// caller must check the range first.
  float operator()(const float& speed) const {
    const uint16_t cell = cell_of(speed, mantissa_bits);
    const uint16_t index = cell < first ? 0U : static_cast<uint16_t>(cell - first + 1U);
    if (index >= count) return float_math::not_a_number();
    const float slope = flash_float(&lines[index].slope);
    const float offset = flash_float(&lines[index].offset);
    return slope * speed + (bits_of(speed) >> 31U != 0 ? -offset : offset);
  }
};

/// A resistance that jumps at rest, such as Coulomb friction. At speeds of at least `rest_speed` it
/// is a table, at lower speeds the straight line from the origin to g(rest_speed).
struct RestingTable {
  ResistanceTable table;
  float rest_speed;  ///< m/s or rad/s; 0: the resistance does not jump
  float at_rest;     ///< g(rest_speed)

  float operator()(const float& speed) const {
    return is_resting(speed) ? at_rest / rest_speed * speed : table(speed);
  }
  /// True if |speed| < rest_speed; false for NaN.
  bool is_resting(float speed) const {
    return float_math::magnitude_bits(speed) < bits_of(rest_speed);
  }
};

}  // namespace awmr
