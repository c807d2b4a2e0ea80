/// Cyclic redundancy checks, computed without a table.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace awmr {

/// CRC-32 of IEEE 802.3 (reflected, polynomial 0xEDB88320), as used by zip and PNG. The CRC of
/// "123456789" is 0xCBF43926. To compute a CRC, start with kCrc32Start, process the bytes in order,
/// and invert the bits of the result: ~crc.
constexpr uint32_t kCrc32Start = 0xFFFFFFFFUL;

inline uint32_t crc32_with(uint32_t crc, uint8_t byte) {
  crc ^= byte;
  for (uint8_t bit = 0; bit < 8; ++bit) {
    crc = (crc & 1U) != 0 ? (crc >> 1U) ^ 0xEDB88320UL : crc >> 1U;
  }
  return crc;
}

/// CRC-16 of CCITT with the initial value 0xFFFF, without reflection and final inversion. Used for
/// command frames and log rows. The CRC of "123456789" is 0x29B1.
constexpr uint16_t kCrc16Start = 0xFFFFU;

inline uint16_t crc16_with(uint16_t crc, uint8_t byte) {
  // For the polynomial x^16 + x^12 + x^5 + 1, these shifts equal the usual loop over the eight bits
  // of a byte.
  uint8_t high = static_cast<uint8_t>((crc >> 8U) ^ byte);
  high = static_cast<uint8_t>(high ^ (high >> 4U));
  const uint16_t folded = static_cast<uint16_t>((static_cast<uint16_t>(high) << 12U) ^
                                                (static_cast<uint16_t>(high) << 5U) ^ high);
  return static_cast<uint16_t>(static_cast<uint16_t>(crc << 8U) ^ folded);
}

inline uint16_t crc16_of(const uint8_t* bytes, size_t size) {
  uint16_t crc = kCrc16Start;
  for (size_t i = 0; i < size; ++i) crc = crc16_with(crc, bytes[i]);
  return crc;
}

}  // namespace awmr
