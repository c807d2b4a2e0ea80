/* Arduino Mega 2560: pins, the servo's timer, the GPS's port, the card's select pin. */
#ifndef AWMR_BOARD_MEGA2560_H
#define AWMR_BOARD_MEGA2560_H

#define AWMR_BOARD_HAS_CARD 1

namespace awmr_board {

const uint8_t kServoPin = 6;  /* OC4A: 50 Hz by timer 4 */
const uint8_t kLeftPwmPin = 44, kLeftDirectionPin = 22;   /* OC5C, by timer 5 */
const uint8_t kRightPwmPin = 45, kRightDirectionPin = 23; /* OC5B */
const uint8_t kSdSelectPin = 53;

/* The GPS is connected to RX1, pin 19. */
inline Stream& begin_gps_port() {
  Serial1.begin(38400);
  return Serial1;
}

inline void set_servo(uint16_t half_us) { OCR4A = half_us; }

/* half_us: pulse width in units of 0.5 us. Timer 4, fast PWM to ICR4, clock/8: a count is 0.5 us, a
   period 20 ms. */
inline void begin_servo(uint16_t half_us) {
  pinMode(kServoPin, OUTPUT);
  TCCR4A = _BV(COM4A1) | _BV(WGM41);
  TCCR4B = _BV(WGM43) | _BV(WGM42) | _BV(CS41);
  ICR4 = 39999;
  set_servo(half_us);
}

}  // namespace awmr_board

#endif /* AWMR_BOARD_MEGA2560_H */
