/// Reads constants from the flash of an AVR, where flash is a separate address space. On other
/// processors, these constants are ordinary ones.
#pragma once

#include <stdint.h>
#include <string.h>

/// AWMR_IN_FLASH marks a constant that is only in flash and needs no RAM. AWMR_SHARED marks a
/// function with several callers: inlining it would need more flash. AWMR_INLINE marks a template
/// with one caller, which must be inlined.
#ifdef __AVR__
#include <avr/pgmspace.h>
#define AWMR_IN_FLASH PROGMEM
#define AWMR_SHARED __attribute__((noinline))
#define AWMR_INLINE inline __attribute__((always_inline))
#else
#define AWMR_IN_FLASH
#define AWMR_SHARED
#define AWMR_INLINE inline
#endif

namespace awmr {

/// Reads a float from flash at `address`.
inline float flash_float(const float* address) {
#ifdef __AVR__
  return pgm_read_float(address);
#else
  return *address;
#endif
}

/// Reads a byte from flash at `address`.
inline uint8_t flash_byte(const uint8_t* address) {
#ifdef __AVR__
  return pgm_read_byte(address);
#else
  return *address;
#endif
}

/// Copies the object in flash at `source` to `value`.
template <class V>
void read_flash(const V* source, V& value) {
#ifdef __AVR__
  memcpy_P(&value, source, sizeof value);
#else
  value = *source;
#endif
}

}  // namespace awmr
