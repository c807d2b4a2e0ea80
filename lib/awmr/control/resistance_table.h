/// Table of a resistance g(w) as a function of the speed w. The table replaces powf, which is slow
/// on the chip.
///
/// The table has 2^m cells (ranges of speed) per octave, evenly spaced in the octave, so the
/// relative error is similar at all speeds. All speeds of a cell have the same float exponent and
/// the same m leading mantissa bits. So a shift of the float's bits gives the index of the cell,
/// without a logarithm. Within a cell, the table gives the chord: the straight line through the
/// curve's points at both ends of the cell. This needs one multiplication and one addition. Below
/// the first cell, the table gives the straight line from the origin to the curve's point at the
/// start of this cell. The table is odd: g(-w) = -g(w).
#pragma once

#include <stdint.h>

#include "awmr/control/flash.h"
#include "awmr/model/float_math.h"

namespace awmr {

/// The resistance within one cell of the table: g(w) = offset + slope w for w >= 0. The struct has
/// no padding, so that a check sum can cover it.
struct ResistanceLine {
  float slope;   ///< in the unit of g divided by the unit of w
  float offset;  ///< in the unit of g
};

/// A table of a resistance. It refers to its lines, but does not own them.
struct ResistanceTable {
  /// Straight lines of the table, in ascending order of speed; in flash on an AVR. lines[0] runs
  /// through the origin (its resistance has no offset) and is for the speeds below all cells. Each
  /// further element is for one cell.
  const ResistanceLine* lines;
  uint16_t count;         ///< number of lines, >= 2
  uint16_t first;         ///< cell_of() for the speeds of the first cell, whose line is lines[1]
  uint8_t mantissa_bits;  ///< m, in [0, 7]

  /// Number of the cell that contains a speed: exponent and leading mantissa bits of the float.
  static uint16_t cell_of(float speed, uint8_t mantissa_bits) {
    return static_cast<uint16_t>(float_math::leading_bits(speed) >> (7U - mantissa_bits));
  }

  /// Returns g(speed), for a speed in m/s or rad/s. Beyond the last cell, and for NaN, the result
  /// is NaN.
  float operator()(const float& speed) const {
    const uint16_t cell = cell_of(speed, mantissa_bits);
    const uint16_t index = cell < first ? 0U : static_cast<uint16_t>(cell - first + 1U);
    if (index >= count) return float_math::not_a_number();
    const float slope = flash_float(&lines[index].slope);
    const float offset = flash_float(&lines[index].offset);
    return slope * speed + (bits_of(speed) >> 31U != 0 ? -offset : offset);
  }
};

/// A resistance that jumps at rest, such as Coulomb friction. At speeds of at least `rest_speed`,
/// it is a table. At lower speeds, it is the straight line from the origin to g(rest_speed).
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
