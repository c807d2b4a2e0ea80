/* Servo and motors. */
#ifndef AWMR_BOARD_ACTUATORS_H
#define AWMR_BOARD_ACTUATORS_H

namespace awmr_board {

inline void begin_actuators() {
  pinMode(kServoPin, OUTPUT);
  pinMode(kLeftPwmPin, OUTPUT);
  pinMode(kLeftDirectionPin, OUTPUT);
  pinMode(kRightPwmPin, OUTPUT);
  pinMode(kRightDirectionPin, OUTPUT);
  /* Timer 4, fast PWM to ICR4, clock/8: half a microsecond a count, 20 ms a period. */
  TCCR4A = _BV(COM4A1) | _BV(WGM41);
  TCCR4B = _BV(WGM43) | _BV(WGM42) | _BV(CS41);
  ICR4 = 39999;
  OCR4A = 2 * kServoCentreUs;
}

inline void drive_motor(uint8_t pwm_pin, uint8_t direction_pin, float force) {
  digitalWrite(direction_pin, force < 0.0f ? HIGH : LOW);
  const float size = force < 0.0f ? -force : force;
  analogWrite(pwm_pin, static_cast<int>(255.0f * size + 0.5f));
}

inline void drive(const awmr_output& out) {
  OCR4A = static_cast<uint16_t>(2.0f * (kServoCentreUs + kServoUsPerRad * out.steering_rad));
  drive_motor(kLeftPwmPin, kLeftDirectionPin, out.force_left);
  drive_motor(kRightPwmPin, kRightDirectionPin, out.force_right);
}

}  // namespace awmr_board

#endif /* AWMR_BOARD_ACTUATORS_H */
