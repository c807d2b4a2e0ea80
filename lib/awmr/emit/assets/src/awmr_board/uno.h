/* Arduino Uno (ATmega328P): pins, the servo's timer, the GPS's port. The Uno writes no log, because
   its 2 KiB of RAM have no room for the log's ring buffer and the card's library. */
#ifndef AWMR_BOARD_UNO_H
#define AWMR_BOARD_UNO_H

#include <SoftwareSerial.h>

#define AWMR_BOARD_HAS_CARD 0

namespace awmr_board {

const uint8_t kServoPin = 9;  /* OC1A: 50 Hz by timer 1 */
const uint8_t kLeftPwmPin = 5, kLeftDirectionPin = 4;  /* OC0B, by timer 0, as millis() */
const uint8_t kRightPwmPin = 6, kRightDirectionPin = 7; /* OC0A */
const uint8_t kGpsPin = 8, kUnusedPin = 12;

/* The GPS is connected to pin 8. The software receiver disables interrupts for the duration of a
   character: 1 ms at 9600 baud. */
static SoftwareSerial gps_serial(kGpsPin, kUnusedPin);
inline Stream& begin_gps_port() {
  gps_serial.begin(9600);
  return gps_serial;
}

inline void set_servo(uint16_t half_us) { OCR1A = half_us; }

/* half_us: pulse width in units of 0.5 us. Timer 1, fast PWM to ICR1, clock/8: a count is 0.5 us, a
   period 20 ms. */
inline void begin_servo(uint16_t half_us) {
  pinMode(kServoPin, OUTPUT);
  TCCR1A = _BV(COM1A1) | _BV(WGM11);
  TCCR1B = _BV(WGM13) | _BV(WGM12) | _BV(CS11);
  ICR1 = 39999;
  set_servo(half_us);
}

}  // namespace awmr_board

#endif /* AWMR_BOARD_UNO_H */
