/// What the firmware knows of its vehicle, as one block with a check sum. Freestanding C++14.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "awmr/control/controller.h"
#include "awmr/control/crc.h"
#include "awmr/control/flash.h"
#include "awmr/control/safety.h"

namespace awmr {

/// Where a table's entries lie: see ResistanceTable.
struct TableShape {
  uint32_t count;
  uint32_t first;
  uint32_t mantissa_bits;
  float slope_at_rest;
};

/// Of 32-bit members only, so without padding: the same bytes on every little-endian machine.
struct ParameterBlock {
  float surge_alpha_beta[2];
  float yaw_alpha_beta[2];
  ControlConstants<float> constants;
  SafetyLimits safety;
  TableShape surge_table;  ///< count 0: by powf
  TableShape yaw_table;
};

/// CRC-32 going on over `size` bytes that lie in flash on an AVR.
inline uint32_t crc32_of_flash(uint32_t crc, const void* address, size_t size) {
  const uint8_t* bytes = static_cast<const uint8_t*>(address);
  for (size_t i = 0; i < size; ++i) crc = crc32_with(crc, flash_byte(bytes + i));
  return crc;
}

/// Of the block, the surge table's values and the yaw table's, in this order.
inline uint32_t crc32_of_parameters(const ParameterBlock* block, const float* surge_values,
                                    size_t surge_count, const float* yaw_values, size_t yaw_count) {
  uint32_t crc = crc32_of_flash(kCrc32Start, block, sizeof *block);
  crc = crc32_of_flash(crc, surge_values, surge_count * sizeof(float));
  return ~crc32_of_flash(crc, yaw_values, yaw_count * sizeof(float));
}

}  // namespace awmr
