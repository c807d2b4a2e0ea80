// Heading and speed hold on the source paper's hardware. Serial, 115200 baud: "H 30" heads 30 deg (before the
// first one: as it stands at the start), "S 1.0" drives at 1 m/s, "M 2" takes the combined mode; silence for
// AWMR_COMMAND_TIMEOUT_MS stops.
#include <SD.h>
#include <SPI.h>
#include <Wire.h>
#include <awmr.h>
#include <awmr_paper_board.h>

awmr_board::Imu imu;
awmr_board::Gps gps;
awmr_board::Log card;
awmr_input input;
uint32_t next_step_us;
bool has_reference = false;

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

void read_command() {
  if (Serial.available() == 0) return;
  const int letter = Serial.read();
  if (letter != 'H' && letter != 'S' && letter != 'M') return;
  const float value = Serial.parseFloat();
  if (letter == 'H') {
    input.psi_ref_rad = value * 0.0174532925f;
    has_reference = true;
  }
  if (letter == 'S') input.u_ref_mps = value;
  if (letter == 'M') input.mode = static_cast<uint8_t>(value);
  input.command_ms = millis();
}

void loop() {
  read_command();
  gps.read();
  if (static_cast<int32_t>(micros() - next_step_us) < 0) return;
  next_step_us += kStepUs;

  imu.read(AWMR_SAMPLE_TIME_S);
  if (!has_reference && imu.has_heading()) {
    input.psi_ref_rad = imu.psi_rad;
    has_reference = true;
  }
  input.psi_rad = imu.psi_rad;
  input.r_radps = imu.r_radps;
  input.heading_ms = imu.time_ms;
  input.u_mps = gps.speed_mps;
  input.x_m = gps.x_m;
  input.y_m = gps.y_m;
  input.speed_ms = gps.time_ms;
  input.now_ms = millis();

  awmr_output output;
  awmr_step(&input, &output);
  awmr_board::drive(output);
  card.write(input, output);
}
