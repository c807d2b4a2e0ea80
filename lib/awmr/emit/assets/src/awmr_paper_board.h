/* The source paper's hardware for the example sketches: MPU9250 for heading and yaw rate, GPS for speed and
   position, a servo, two motor drivers, a log on an SD card. Arduino Mega 2560; header-only, so that
   the library itself needs neither Wire nor SD; to be included by the sketch alone. Axes: x north,
   y west, z up; heading counter-clockwise from north.

   Everything that drives runs in a timer interrupt (begin_steps); loop() has nothing to do but the
   card, which may make it wait. */
#ifndef AWMR_PAPER_BOARD_H
#define AWMR_PAPER_BOARD_H

#include <Arduino.h>
#include <SD.h>
#include <Wire.h>

#include "awmr.h"

namespace awmr_board {

/* Wiring */
const uint8_t kServoPin = 6;  /* OC4A: 50 Hz by timer 4 */
const uint8_t kLeftPwmPin = 44, kLeftDirectionPin = 22;   /* OC5C, by timer 5 */
const uint8_t kRightPwmPin = 45, kRightDirectionPin = 23; /* OC5B */
const uint8_t kSdSelectPin = 53;
const uint16_t kServoCentreUs = 1500;
const float kServoUsPerRad = 573.0f; /* 10 us per degree of the wheels: measure yours */

}  // namespace awmr_board

#include "awmr_board/actuators.h"
#include "awmr_board/card.h"
#include "awmr_board/command.h"
#include "awmr_board/gps.h"
#include "awmr_board/imu.h"
#include "awmr_board/steps.h"

namespace awmr_board {

/* What the sensors know, with its times. */
inline void measure(const Imu& imu, const Gps& gps, awmr_input& input) {
  input.psi_rad = imu.psi_rad;
  input.r_radps = imu.r_radps;
  input.heading_ms = imu.time_ms;
  input.u_mps = gps.speed_mps;
  input.x_m = gps.x_m;
  input.y_m = gps.y_m;
  input.speed_ms = gps.time_ms;
  input.now_ms = millis();
}

}  // namespace awmr_board

#endif /* AWMR_PAPER_BOARD_H */
