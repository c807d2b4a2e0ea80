// Drives along waypoints on the source paper's hardware, in m north and west of the first GPS fix, and stops at
// the last. Send any character over Serial (115200 baud) at least every AWMR_COMMAND_TIMEOUT_MS to
// keep it going: letting go is the dead man's switch.
#include <SD.h>
#include <SPI.h>
#include <Wire.h>
#include <awmr.h>
#include <awmr_paper_board.h>

const awmr_point kPoints[] = {{10.0f, 20.0f}, {0.0f, 40.0f}, {-10.0f, 20.0f}, {0.0f, 0.0f}};
const float kAcceptanceM = 2.0f;
const float kSpeedMps = 1.0f;

awmr_board::Imu imu;
awmr_board::Gps gps;
awmr_board::Log card;
awmr_input input;
uint32_t next_step_us;
bool is_under_way = false;

const uint32_t kStepUs = static_cast<uint32_t>(AWMR_SAMPLE_TIME_S * 1e6f);

void setup() {
  Serial.begin(115200);
  awmr_board::begin_actuators();
  imu.begin();
  gps.begin();
  if (!card.begin()) Serial.println(F("no SD card: no log"));
  if (awmr_init() != AWMR_FAULT_NONE) Serial.println(F("parameters damaged: flash again"));
  input.mode = AWMR_COMBINED;
  next_step_us = micros() + kStepUs;
}

void loop() {
  while (Serial.available() > 0) {
    Serial.read();
    input.command_ms = millis();
  }
  gps.read();
  if (static_cast<int32_t>(micros() - next_step_us) < 0) return;
  next_step_us += kStepUs;

  imu.read(AWMR_SAMPLE_TIME_S);
  input.psi_rad = imu.psi_rad;
  input.r_radps = imu.r_radps;
  input.heading_ms = imu.time_ms;
  input.u_mps = gps.speed_mps;
  input.x_m = gps.x_m;
  input.y_m = gps.y_m;
  input.speed_ms = gps.time_ms;
  input.now_ms = millis();
  if (!is_under_way && gps.time_ms != 0) {
    awmr_follow(kPoints, sizeof kPoints / sizeof kPoints[0], kAcceptanceM);
    input.u_ref_mps = kSpeedMps;
    is_under_way = true;
  }

  awmr_output output;
  awmr_step(&input, &output);
  if (output.arrived) input.u_ref_mps = 0.0f;
  awmr_board::drive(output);
  card.write(input, output);
}
