// Drives along waypoints on the source paper's hardware, in m north and west of the first GPS fix, and stops at
// the last. Over Serial (115200 baud) the line "G" starts it, also after a reset; any character at least every
// AWMR_COMMAND_TIMEOUT_MS keeps it going: letting go is the dead man's switch.
#include <Wire.h>
#include <awmr.h>
#include <awmr_paper_board.h>

const awmr_point kPoints[] = {{10.0f, 20.0f}, {0.0f, 40.0f}, {-10.0f, 20.0f}, {0.0f, 0.0f}};
const float kAcceptanceM = 2.0f;
const float kSpeedMps = 1.0f;

awmr_board::Imu imu;
awmr_board::Gps gps;
awmr_board::Log card;
awmr_board::Command command;
awmr_input input;
bool is_told_to_go = false;
bool is_under_way = false;

void step() {
  while (command.read()) {
    if (command.letter == 'G') is_told_to_go = true;
  }
  gps.read();
  imu.read(AWMR_SAMPLE_TIME_S);
  awmr_board::measure(imu, gps, command, input);
  // Before it is told to go nobody has commanded anything, and the motors are off.
  if (!is_told_to_go) input.command_ms = input.now_ms - AWMR_COMMAND_TIMEOUT_MS - 1;
  if (is_told_to_go && !is_under_way && gps.time_ms != 0) {
    awmr_follow(kPoints, sizeof kPoints / sizeof kPoints[0], kAcceptanceM);
    input.u_ref_mps = kSpeedMps;
    is_under_way = true;
  }

  awmr_output output;
  awmr_step(&input, &output);
  if (output.arrived) input.u_ref_mps = 0.0f;
  awmr_board::drive(output);
  card.put(input, output);
}

void setup() {
  awmr_board::begin(imu, gps, card);
  if (gps.has_origin()) Serial.println(F("GPS origin as before the reset"));
  input.mode = AWMR_COMBINED;
  awmr_board::begin_steps(step);
}

void loop() { card.drain(); }
