// Replaces avr-libc's interrupt.h on the host; everything is in Arduino.h.
#pragma once
#include <Arduino.h>
