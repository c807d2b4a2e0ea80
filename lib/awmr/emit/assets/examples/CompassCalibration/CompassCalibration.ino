// Records the magnetic field while the vehicle turns, for `awmr compass FIELD00.CSV -o
// src/awmr_compass.h`. Use level ground away from iron, with everything mounted and switched on as
// for driving. Turn the vehicle slowly through two whole circles, by hand or by commands over
// Serial (115200 baud): "ARM" enables the motors, "T 0.3" drives a circle to the left with 0.3 of
// F_max, the largest wheel force. The motors stop at "STOP", or if no command arrives for a second:
// repeat "KEEP".
#include <SD.h>
#include <SPI.h>
#include <Wire.h>
#include <awmr.h>
#include <awmr_paper_board.h>
#if !AWMR_BOARD_HAS_CARD
#error "This sketch writes the field to a card, which an Uno has no RAM for: record with a Mega 2560."
#endif

struct Row {
  float t_s, ahead, left, yaw_rate_radps;
};

awmr_board::Imu imu;
awmr_board::Command command;
awmr::Arming arming;
File file;
Row row;
volatile bool has_row = false;
float force = 0.0f;
uint32_t last_field_ms = 0;
uint8_t steps_since_row = 0;

const uint8_t kStepsPerRow = 5;

void obey() {
  if (command.word == awmr::CommandWord::kStop) {
    arming.disarm(awmr::DisarmReason::kStop);
    command.answer(awmr_board::kDisarmed);
  } else if (command.word == awmr::CommandWord::kArm) {
    force = 0.0f;
    arming.arm(AWMR_FAULT_NONE, awmr::kSensorGood);
    command.answer(awmr_board::kArmed);
  } else if (!arming.is_armed()) {
    command.answer(awmr_board::kNotArmed);
  } else if (command.word == awmr::CommandWord::kForce) {
    force = constrain(command.value, 0.0f, AWMR_WHEEL_FORCE_MAX);
    command.answer(awmr_board::kOk);
  } else if (command.word != awmr::CommandWord::kKeep) {
    command.answer(awmr_board::kUnknown);
  }
}

void receive() {
  while (command.read()) obey();
}

void step() {
  // Only STOP and a pause of the commands switch the motors off. Sensor faults do not, because the
  // compass is not calibrated yet.
  if (millis() - command.heard_ms >= 1000) arming.disarm(awmr::DisarmReason::kTimeout);
  if (!arming.is_armed()) force = 0.0f;
  awmr_output output = awmr_output();
  output.force_left = force;
  output.force_right = force;
  output.steering_rad = force > 0.0f ? AWMR_STEERING_MAX_RAD : 0.0f;
  awmr_board::drive(output);

  imu.read(AWMR_SAMPLE_TIME_S);
  if (++steps_since_row < kStepsPerRow || has_row || imu.field_ms == last_field_ms) return;
  steps_since_row = 0;
  last_field_ms = imu.field_ms;
  row.t_s = awmr_board::step_number() * AWMR_SAMPLE_TIME_S;
  row.ahead = imu.field_ahead;
  row.left = imu.field_left;
  row.yaw_rate_radps = imu.r_radps;
  has_row = true;
}

void setup() {
  Serial.begin(115200);
  awmr_board::begin_actuators();
  imu.begin();
  if (SD.begin(awmr_board::kSdSelectPin)) file = awmr_board::next_file("FIELD00.CSV");
  if (!file) Serial.println(F("no SD card: the record comes over this line alone"));
  Serial.println(F("t_s,field_ahead,field_left,yaw_rate_radps"));
  file.println(F("t_s,field_ahead,field_left,yaw_rate_radps"));
  awmr_board::begin_steps(receive, step);
}

void print_row(Print& to) {
  const float values[] = {row.t_s, row.ahead, row.left, row.yaw_rate_radps};
  for (uint8_t i = 0; i < 4; ++i) {
    if (i > 0) to.print(',');
    to.print(values[i], i == 1 || i == 2 ? 2 : 4);
  }
  to.println();
}

void loop() {
  command.speak();
  if (!has_row) return;
  print_row(Serial);
  if (file) {
    print_row(file);
    file.flush();
  }
  has_row = false;
}
