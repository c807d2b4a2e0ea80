/* Servo and motors. */
#ifndef AWMR_BOARD_ACTUATORS_H
#define AWMR_BOARD_ACTUATORS_H

namespace awmr_board {

/* Call in setup(): sets the pins of motors and servo, wheels straight. */
inline void begin_actuators() {
  pinMode(kLeftPwmPin, OUTPUT);
  pinMode(kLeftDirectionPin, OUTPUT);
  pinMode(kRightPwmPin, OUTPUT);
  pinMode(kRightDirectionPin, OUTPUT);
  begin_servo(2 * kServoCentreUs);
}

/* force: F' in [-1, 1]; the direction pin is high for a negative force. Before a change of the
   direction the PWM is set to 0, so that the old duty never drives the motor the other way. */
inline void drive_motor(uint8_t pwm_pin, uint8_t direction_pin, float force) {
  const uint8_t direction = force < 0.0f ? HIGH : LOW;
  if (digitalRead(direction_pin) != direction) {
    analogWrite(pwm_pin, 0);
    digitalWrite(direction_pin, direction);
  }
  const float size = force < 0.0f ? -force : force;
  analogWrite(pwm_pin, static_cast<int>(255.0f * size + 0.5f));
}

/* Sets the command to motors off, wheels straight; drive() applies it. */
inline void stop(awmr_output& out) {
  out.force_left = 0.0f;
  out.force_right = 0.0f;
  out.steering_rad = 0.0f;
}

/* Commands motors and servo. */
inline void drive(const awmr_output& out) {
  set_servo(
      static_cast<uint16_t>(2.0f * (kServoCentreUs + kServoUsPerRad * out.steering_rad)));
  drive_motor(kLeftPwmPin, kLeftDirectionPin, out.force_left);
  drive_motor(kRightPwmPin, kRightDirectionPin, out.force_right);
}

}  // namespace awmr_board

#endif /* AWMR_BOARD_ACTUATORS_H */
