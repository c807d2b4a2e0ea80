// Heading and speed hold on the source paper's hardware. Serial, 115200 baud, a line each: "H 30" heads 30 deg
// (before the first one: as it stands at the start), "S 1.0" drives at 1 m/s, "M 2" takes the combined mode;
// silence for AWMR_COMMAND_TIMEOUT_MS stops.
#include <Wire.h>
#include <awmr.h>
#include <awmr_paper_board.h>

awmr_board::Imu imu;
awmr_board::Gps gps;
awmr_board::Log card;
awmr_board::Command command;
awmr_input input;
bool has_reference = false;

void obey() {
  if (command.letter == 'H') {
    input.psi_ref_rad = command.value * 0.0174532925f;
    has_reference = true;
  }
  if (command.letter == 'S') input.u_ref_mps = command.value;
  if (command.letter == 'M') input.mode = static_cast<uint8_t>(command.value);
}

void step() {
  while (command.read()) obey();
  gps.read();
  imu.read(AWMR_SAMPLE_TIME_S);
  if (!has_reference && imu.has_heading()) {
    input.psi_ref_rad = imu.psi_rad;
    has_reference = true;
  }
  awmr_board::measure(imu, gps, command, input);

  awmr_output output;
  awmr_step(&input, &output);
  awmr_board::drive(output);
  card.put(input, output);
}

void setup() {
  awmr_board::begin(imu, gps, card);
  input.mode = AWMR_COMBINED;
  awmr_board::begin_steps(step);
}

void loop() { card.drain(); }
