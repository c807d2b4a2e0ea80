/// Constants that stay in the flash of an AVR, whose program memory has an address space of its
/// own. Elsewhere they are constants as any. Freestanding C++14.
#pragma once

#include <stdint.h>
#include <string.h>

#ifdef __AVR__
#include <avr/pgmspace.h>
#define AWMR_IN_FLASH PROGMEM
#else
#define AWMR_IN_FLASH
#endif

namespace awmr {

inline float flash_float(const float* address) {
#ifdef __AVR__
  return pgm_read_float(address);
#else
  return *address;
#endif
}

inline uint8_t flash_byte(const uint8_t* address) {
#ifdef __AVR__
  return pgm_read_byte(address);
#else
  return *address;
#endif
}

/// The 32 bits of a float, and back.
inline uint32_t bits_of(float value) {
  uint32_t bits = 0;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline float float_of(uint32_t bits) {
  float value = 0.0F;
  memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace awmr
