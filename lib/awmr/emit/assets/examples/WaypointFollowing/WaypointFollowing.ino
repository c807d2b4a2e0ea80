// Drives along waypoints on the source paper's hardware, and stops at the last one. Waypoints are
// in m north (x) and west (y) of the first GPS fix. Over Serial, 115200 baud, one command per line:
//   ARM     enables the motors    G   drive the route from its first point on
//   KEEP    continue: without a command for AWMR_COMMAND_TIMEOUT_MS the motors stop
//   STOP    motors off, at once
// After a reset, STOP, a command time-out, any fault and the last point, the motors are off until
// the next ARM (SAFETY.md).
#include <Wire.h>
#include <awmr.h>
#include <awmr_paper_board.h>

const awmr_point kPoints[] = {{10.0f, 20.0f}, {0.0f, 40.0f}, {-10.0f, 20.0f}, {0.0f, 0.0f}};
const float kAcceptanceM = 2.0f;
const float kSpeedMps = AWMR_ROUTE_SPEED_MPS;
// Time after the arrival at the last point after which the sketch disarms even a moving vehicle.
const uint32_t kBrakingMs = 5000;

awmr_board::Imu imu;
awmr_board::Gps gps;
awmr_board::Log card;
awmr_board::Command command;
awmr_board::Safety safety;
awmr_input input;
awmr_output output;
bool has_arrived = false;
uint32_t arrived_ms = 0;

void follow(int16_t count) {
  awmr_follow(kPoints, count, kAcceptanceM);
  has_arrived = false;
}

void receive() {
  bool armed_now = false;
  while (safety.read(command, armed_now)) {
    if (armed_now) {
      follow(0);
      input.psi_ref_rad = imu.psi_rad;
      input.u_ref_mps = 0.0f;
    } else if (command.word == awmr::CommandWord::kGo) {
      follow(sizeof kPoints / sizeof kPoints[0]);
      input.u_ref_mps = kSpeedMps;
      command.answer(awmr_board::kOk);
    } else {
      command.answer(awmr_board::kUnknown);
    }
  }
  gps.receive();
}

void step() {
  awmr_board::step(imu, gps, command, safety, card, input, output);
  if (output.arrived && !has_arrived) {
    has_arrived = true;
    arrived_ms = input.now_ms;
    input.u_ref_mps = 0.0f;
  }
  if (has_arrived && safety.is_armed() &&
      (gps.speed_mps < awmr::kStandstill_mps || input.now_ms - arrived_ms > kBrakingMs)) {
    safety.stop(command, awmr::DisarmReason::kArrived);
  }
}

void setup() {
  awmr_board::begin(imu, gps, card);
  input.mode = AWMR_COMBINED;
  awmr_board::begin_steps(receive, step);
}

void loop() {
  command.speak();
  card.drain();
}
