/// Constants that stay in the flash of an AVR, whose program memory has an address space of its
/// own. Elsewhere they are constants as any. Freestanding C++14.
#pragma once

#include <stdint.h>
#include <string.h>

/// AWMR_IN_FLASH: a constant that takes no RAM. AWMR_SHARED: a function called from several places
/// that is not to be copied into each. AWMR_INLINE: a template called from one place only, which
/// the compiler would call all the same, as another file might instantiate it too.
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

/// Reads a float that lies in flash at `address`.
inline float flash_float(const float* address) {
#ifdef __AVR__
  return pgm_read_float(address);
#else
  return *address;
#endif
}

/// Reads a byte that lies in flash at `address`.
inline uint8_t flash_byte(const uint8_t* address) {
#ifdef __AVR__
  return pgm_read_byte(address);
#else
  return *address;
#endif
}

/// Copies what lies in flash at `source` to `value`.
template <class V>
void read_flash(const V* source, V& value) {
#ifdef __AVR__
  memcpy_P(&value, source, sizeof value);
#else
  value = *source;
#endif
}

}  // namespace awmr
