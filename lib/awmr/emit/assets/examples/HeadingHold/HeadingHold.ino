// Holds heading and speed on the source paper's hardware. Over Serial, 115200 baud, one command per
// line:
//   ARM     enables the motors, at speed 0 and on the current heading
//   S 1.0   drive at 1 m/s        H 30   head 30 deg        M 2   combined mode
//   KEEP    continue: without a command for AWMR_COMMAND_TIMEOUT_MS the motors stop
//   STOP    motors off, at once
// After a reset, STOP, a command time-out and any fault, the motors are off until the next ARM
// (SAFETY.md).
#include <Wire.h>
#include <awmr.h>
#include <awmr_paper_board.h>

awmr_board::Imu imu;
awmr_board::Gps gps;
awmr_board::Log card;
awmr_board::Command command;
awmr_board::Safety safety;
awmr_input input;
awmr_output output;

void obey() {
  const float value = command.value;
  if (command.word == awmr::CommandWord::kHeading && fabs(value) <= 3600.0f) {
    input.psi_ref_rad = value * 0.0174532925f;
  } else if (command.word == awmr::CommandWord::kSpeed && fabs(value) <= AWMR_COMMAND_SPEED_MAX_MPS) {
    input.u_ref_mps = value;
  } else if (command.word == awmr::CommandWord::kMode && (value == 0.0f || value == 1.0f || value == 2.0f)) {
    input.mode = static_cast<uint8_t>(value);
  } else {
    return command.answer(awmr_board::kOutOfRange);
  }
  command.answer(awmr_board::kOk);
}

void receive() {
  bool armed_now = false;
  while (safety.read(command, armed_now)) {
    if (armed_now) {
      input.psi_ref_rad = imu.psi_rad;
      input.u_ref_mps = 0.0f;
    } else {
      obey();
    }
  }
  gps.receive();
}

void step() { awmr_board::step(imu, gps, command, safety, card, input, output); }

void setup() {
  awmr_board::begin(imu, gps, card);
  input.mode = AWMR_COMBINED;
  awmr_board::begin_steps(receive, step);
}

void loop() {
  command.speak();
  card.drain();
}
