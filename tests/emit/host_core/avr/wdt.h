// Watchdog functions without effect.
#pragma once
#include <Arduino.h>
enum { WDTO_250MS = 4, WDTO_500MS, WDTO_1S, WDTO_2S, WDTO_4S };
inline void wdt_enable(uint8_t) {}
inline void wdt_disable() {}
inline void wdt_reset() {}
