/* The timer that calls the control step: its interrupt AWMR_BOARD_TICK (a tick), and its start. A
   sample time is a whole number of ticks. Ticks must be so short that the serial ports' buffers of
   63 characters do not overflow between them. At 115200 baud, a buffer is full after 5.4 ms, and a
   step takes up to 1.25 ms. */
#ifndef AWMR_BOARD_TICKS_H
#define AWMR_BOARD_TICKS_H

#include <avr/io.h>
#include <stdint.h>

namespace awmr_board {

#if defined(__AVR_ATmega2560__)
#define AWMR_BOARD_TICK TIMER3_COMPA_vect

/* Starts timer 3: at most 8000 counts of clock/8, 4 ms. Returns the ticks per sample time. */
inline uint16_t begin_ticks(float sample_time_s) {
  float counts = sample_time_s * (F_CPU / 8);
  uint16_t ticks = 1;
  for (; counts > 8000.0f; counts *= 0.5f) ticks *= 2;
  TCCR3A = 0;
  TCCR3B = 0;
  TCNT3 = 0;
  OCR3A = static_cast<uint16_t>(counts - 0.5f);
  TCCR3B = _BV(WGM32) | _BV(CS31);
  TIMSK3 = _BV(OCIE3A);
  return ticks;
}

#elif defined(__AVR_ATmega328P__)
#define AWMR_BOARD_TICK TIMER2_COMPA_vect

/* Starts timer 2: at most 256 counts of clock/64, 1.024 ms. Returns the ticks per sample time. */
inline uint16_t begin_ticks(float sample_time_s) {
  const float counts = sample_time_s * (F_CPU / 64);
  const uint16_t ticks = static_cast<uint16_t>(counts / 256.0f + 0.999f);
  TCCR2A = _BV(WGM21);
  TCCR2B = _BV(CS22);
  TCNT2 = 0;
  OCR2A = static_cast<uint8_t>(counts / ticks - 0.5f);
  TIMSK2 = _BV(OCIE2A);
  return ticks;
}
#endif

}  // namespace awmr_board

#endif /* AWMR_BOARD_TICKS_H */
