/* What is the Arduino Uno's own (ATmega328P): pins, the servo's timer, the GPS's port. It has 2 KiB of RAM,
   which the log's ring and the card's library would not leave anything of. */
#ifndef AWMR_BOARD_UNO_H
#define AWMR_BOARD_UNO_H

#include <SoftwareSerial.h>

#define AWMR_BOARD_HAS_CARD 0

namespace awmr_board {

const uint8_t kServoPin = 9;  /* OC1A: 50 Hz by timer 1 */
const uint8_t kLeftPwmPin = 5, kLeftDirectionPin = 4;  /* OC0B, by timer 0, as millis() */
const uint8_t kRightPwmPin = 6, kRightDirectionPin = 7; /* OC0A */
const uint8_t kGpsPin = 8, kUnusedPin = 12;

/* The GPS sends to pin 8, at 9600 baud: a receiver that is made of pin changes has interrupts off for
   as long as a character lasts. */
static SoftwareSerial gps_serial(kGpsPin, kUnusedPin);
inline Stream& begin_gps_port() {
  gps_serial.begin(9600);
  return gps_serial;
}

inline void set_servo(uint16_t half_us) { OCR1A = half_us; }

/* Timer 1, fast PWM to ICR1, clock/8: half a microsecond a count, 20 ms a period. */
inline void begin_servo(uint16_t half_us) {
  pinMode(kServoPin, OUTPUT);
  TCCR1A = _BV(COM1A1) | _BV(WGM11);
  TCCR1B = _BV(WGM13) | _BV(WGM12) | _BV(CS11);
  ICR1 = 39999;
  set_servo(half_us);
}

}  // namespace awmr_board

#endif /* AWMR_BOARD_UNO_H */
