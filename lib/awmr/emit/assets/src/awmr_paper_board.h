/* The source paper's hardware for the example sketches: MPU9250 for heading and yaw rate, GPS for
   speed and position, a servo, two motor drivers, a log on an SD card. Arduino Mega 2560, or an Uno
   without the card. Header-only, so that the library itself needs neither Wire nor SD; include it
   only in the sketch. Axes: x north, y west, z up; heading counter-clockwise from north.

   The code that drives, receive() and step(), runs in a timer interrupt (begin_steps). loop()
   handles only the card, which can block. */
#ifndef AWMR_PAPER_BOARD_H
#define AWMR_PAPER_BOARD_H

#include <Arduino.h>
#include <Wire.h>

#include "awmr.h"

#if defined(__AVR_ATmega2560__)
#include "awmr_board/mega2560.h"
#elif defined(__AVR_ATmega328P__)
#include "awmr_board/uno.h"
#else
#error "The examples support two boards, Mega 2560 and Uno. For another board, implement the functions of \
awmr_board/uno.h, or call awmr_step() of awmr.h, which needs none of them, from a sketch of your own."
#endif
#if AWMR_BOARD_HAS_CARD
#include <SD.h>
#endif

namespace awmr_board {

const uint16_t kServoCentreUs = 1500;
const float kServoUsPerRad = 573.0f; /* 10 us per degree of the wheels: measure yours */

}  // namespace awmr_board

#include "awmr_board/actuators.h"
#include "awmr_board/card.h"
#include "awmr_board/command.h"
#include "awmr_board/gps.h"
#include "awmr_board/imu.h"
#include "awmr_board/safety.h"
#include "awmr_board/steps.h"

namespace awmr_board {

/* Returns time_ms; before the first reading (is_taken false), a time older than timeout_ms. */
inline uint32_t time_or_old(bool is_taken, uint32_t time_ms, uint32_t now_ms, uint32_t timeout_ms) {
  return is_taken ? time_ms : now_ms - timeout_ms - 1;
}

/* Call in setup() of a sketch that uses the autopilot: starts everything except the steps, and
   reports missing devices over Serial (115200 baud). */
inline void begin(Imu& imu, Gps& gps, Log& card) {
  Serial.begin(115200);
  begin_actuators();
  imu.begin();
  gps.begin();
  if (!AWMR_COMPASS_CALIBRATED) Serial.println(F("compass not calibrated"));
  if (!card.begin()) Serial.println(F("no SD card: no log"));
  if (awmr_init() != AWMR_FAULT_NONE) Serial.println(F("parameters damaged: flash again"));
  Serial.println(F("disarmed: hold still, then ARM"));
}

/* Call in the step: writes sensor readings and time stamps into the input. A rejected sensor keeps
   its old time stamp. When this is older than its time-out, the autopilot reports a fault. */
inline void measure(const Imu& imu, const Gps& gps, const Command& command, awmr_input& input) {
  input.now_ms = millis();
  input.psi_rad = imu.psi_rad;
  input.r_radps = imu.r_radps;
  input.heading_ms =
      time_or_old(imu.has_heading(), imu.time_ms, input.now_ms, AWMR_HEADING_TIMEOUT_MS);
  input.u_mps = gps.speed_mps;
  input.speed_unsigned = 1;
  input.x_m = gps.x_m;
  input.y_m = gps.y_m;
  input.position_is_fix = AWMR_WITH_POSITION_ESTIMATE;
  input.fix_ms = gps.time_ms - AWMR_FIX_LATENCY_MS;
  input.speed_ms = time_or_old(gps.has_fix(), gps.time_ms, input.now_ms, AWMR_SPEED_TIMEOUT_MS);
  input.command_ms =
      time_or_old(command.has_heard, command.heard_ms, input.now_ms, AWMR_COMMAND_TIMEOUT_MS);
}

/* Returns why compass or gyroscope are rejected or, if they are accepted, why the GPS is rejected;
   awmr::kSensorGood if all sensors are accepted. */
inline uint8_t sensor_fault(const Imu& imu, const Gps& gps) {
  const awmr::SensorFault heading = imu.fault();
  return heading != awmr::kSensorGood ? heading : gps.fault();
}

/* One step of a sketch that uses the autopilot: reads the sensors, runs awmr_step(), disarms on a
   fault, drives the motors and logs. Set mode and references of `input` before. */
inline void step(Imu& imu, Gps& gps, Command& command, Safety& safety, Log& card, awmr_input& input,
                 awmr_output& output) {
  gps.step(input.u_ref_mps, imu.psi_rad, output.psi_ref_rad, safety.is_armed());
  imu.read(AWMR_SAMPLE_TIME_S);
  measure(imu, gps, command, input);
  safety.guard(input);
  awmr_step(&input, &output);
  const uint8_t cause = sensor_fault(imu, gps);
  safety.observe(output.fault, cause, command);
  if (!safety.is_armed()) stop(output);
  imu.note_moment(safety.is_armed() ? output.tau_turn_m : 0.0f);
  drive(output);
  card.put(input, output, cause);
}

}  // namespace awmr_board

#endif /* AWMR_PAPER_BOARD_H */
