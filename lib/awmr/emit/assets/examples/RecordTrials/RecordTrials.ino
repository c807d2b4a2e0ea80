// Drives the runs of the field sheet automatically and writes its tables: SURGE00.CSV, TURN00.CSV
// and COAST00.CSV for `awmr identify --surge --turning --coastdown`. Use level, dry ground, and
// drive half of the runs in each direction. A run needs the distance that the vehicle drives in
// settle_s + measure_s (kSettings: 6 s), a coast-down also the distance until rest.
//
// Commands over Serial (115200 baud), one per line: "ARM" enables the motors, first and again after
// each stop or fault. "G" drives the announced run, "N" skips it. During a run a command, such as
// "KEEP", must arrive at least once per second. "STOP" or a longer pause stops the run, which must
// then be driven again. In runs with straight wheels nothing controls the heading: stop the vehicle
// if it leaves its lane.
#include <SD.h>
#include <SPI.h>
#include <Wire.h>
#include <awmr.h>
#include <awmr_paper_board.h>
#if !AWMR_BOARD_HAS_CARD
#error "This sketch writes the trials to a card, which an Uno has no RAM for: record with a Mega 2560."
#endif
#include <awmr_trials.h>

using namespace awmr_trials;

const float kMost = AWMR_WHEEL_FORCE_MAX;
const float kStop = AWMR_STEERING_MAX_RAD;
const Trial kRuns[] = {
    {kSurge, 0.25f * kMost, 0.0f}, {kSurge, 0.25f * kMost, 0.0f}, {kSurge, 0.40f * kMost, 0.0f},
    {kSurge, 0.40f * kMost, 0.0f}, {kSurge, 0.55f * kMost, 0.0f}, {kSurge, 0.55f * kMost, 0.0f},
    {kSurge, 0.70f * kMost, 0.0f}, {kSurge, 0.70f * kMost, 0.0f}, {kSurge, 0.85f * kMost, 0.0f},
    {kSurge, 0.85f * kMost, 0.0f}, {kSurge, kMost, 0.0f}, {kSurge, kMost, 0.0f},
    {kTurning, 0.5f * kMost, 0.25f * kStop}, {kTurning, 0.5f * kMost, -0.25f * kStop},
    {kTurning, 0.5f * kMost, 0.45f * kStop}, {kTurning, 0.5f * kMost, -0.45f * kStop},
    {kTurning, 0.5f * kMost, 0.65f * kStop}, {kTurning, 0.5f * kMost, -0.65f * kStop},
    {kTurning, 0.5f * kMost, 0.85f * kStop}, {kTurning, 0.5f * kMost, -0.85f * kStop},
    {kTurning, 0.5f * kMost, kStop}, {kTurning, 0.5f * kMost, -kStop},
    {kCoastdown, 0.4f * kMost, 0.0f}, {kCoastdown, 0.4f * kMost, 0.0f}, {kCoastdown, 0.7f * kMost, 0.0f},
    {kCoastdown, 0.7f * kMost, 0.0f}, {kCoastdown, kMost, 0.0f}, {kCoastdown, kMost, 0.0f}};
const uint8_t kCount = sizeof kRuns / sizeof kRuns[0];
const Settings kSettings = {3.0f, 3.0f, 15.0f, 0.05f, 0.05f};

awmr_board::Imu imu;
awmr_board::Gps gps;
awmr_board::Command command;
awmr_board::Safety safety;
Recorder recorder(kRuns, kCount, kSettings);
File surge, turning, coastdown;

struct Pending {
  Event event;
  uint8_t number;
  Row row;
};
Pending pending;            // last event of a control step, which loop() writes to the card
volatile bool has_pending = false;
uint16_t rows_lost = 0;

void receive() {
  bool armed_now = false;
  while (safety.read(command, armed_now)) {
    if (armed_now) continue;
    if (command.word == awmr::CommandWord::kGo) {
      recorder.go();
    } else if (command.word == awmr::CommandWord::kNext) {
      recorder.skip();
    } else {
      command.answer(awmr_board::kUnknown);
      continue;
    }
    command.answer(awmr_board::kOk);
  }
  gps.receive();
}

void step() {
  gps.step(recorder.force(), imu.psi_rad, imu.psi_rad, safety.is_armed());
  imu.read(AWMR_SAMPLE_TIME_S);
  const uint32_t now_ms = millis();
  const uint8_t cause = awmr_board::sensor_fault(imu, gps);
  const bool is_heard = command.has_heard && now_ms - command.heard_ms < 1000;
  safety.observe(is_heard ? AWMR_FAULT_NONE : AWMR_FAULT_COMMAND_TIMEOUT, cause, command);
  const uint8_t number = recorder.number();
  const Measured measured = {now_ms, gps.speed_mps, gps.time_ms, imu.r_radps, safety.is_armed()};
  const Event event = recorder.step(measured, cause != awmr::kSensorGood);

  awmr_output output = awmr_output();
  output.force_left = recorder.force();
  output.force_right = recorder.force();
  output.steering_rad = recorder.steering_rad();
  if (!safety.is_armed()) awmr_board::stop(output);
  awmr_board::drive(output);

  if (event == kNothing) return;
  if (has_pending) {
    ++rows_lost;
    return;
  }
  pending.event = event;
  pending.number = number;
  pending.row = recorder.row();
  has_pending = true;
}

File table(const char* name, const __FlashStringHelper* header) {
  File file = awmr_board::next_file(name);
  file.println(header);
  file.flush();
  return file;
}

void announce() {
  if (recorder.state() == kDone) {
    Serial.println(F("all runs are done"));
    return;
  }
  static const char* const kNames[] = {"surge", "turning", "coast-down"};
  const Trial& run = recorder.trial();
  Serial.print(F("run "));
  Serial.print(recorder.number() + 1);
  Serial.print(F(", "));
  Serial.print(kNames[run.kind]);
  Serial.print(F(", F' "));
  Serial.print(run.force, 3);
  Serial.print(F(", steering "));
  Serial.print(run.steering_rad * 57.2957795f, 1);
  Serial.println(F(" deg: G drives, N skips"));
}

void setup() {
  Serial.begin(115200);
  awmr_board::begin_actuators();
  imu.begin();
  gps.begin();
  if (SD.begin(awmr_board::kSdSelectPin)) {
    surge = table("SURGE00.CSV", F("wheel_force,speed_mps"));
    turning = table("TURN00.CSV", F("steering_deg,wheel_force,yaw_rate_radps"));
    coastdown = table("COAST00.CSV", F("run,t_s,speed_mps"));
  }
  if (!surge || !turning || !coastdown) Serial.println(F("no SD card: nothing is recorded"));
  announce();
  awmr_board::begin_steps(receive, step);
}

void print_cells(Print& to, float first, float second) {
  to.print(first, 4);
  to.print(',');
  to.println(second, 4);
}

void write_row(Print& to) {
  const Trial& run = kRuns[pending.number];
  if (pending.event == kCurveRow) {
    to.print(pending.number + 1);
    to.print(',');
    print_cells(to, pending.row.t_s, pending.row.value);
  } else if (run.kind == kTurning) {
    to.print(pending.row.steering_rad * 57.2957795f, 4);
    to.print(',');
    print_cells(to, pending.row.force, pending.row.value);
  } else {
    print_cells(to, pending.row.force, pending.row.value);
  }
}

void loop() {
  command.speak();
  if (!has_pending) return;
  const Event event = pending.event;
  File& file = event == kCurveRow || event == kCoasted ? coastdown
               : kRuns[pending.number].kind == kTurning   ? turning
                                                       : surge;
  if (event == kRow || event == kCurveRow) {
    write_row(Serial);
    write_row(file);
  }
  if (event == kNotSteady) Serial.println(F("not steady, or no GPS: repeat with a longer run-up"));
  if (event == kSensorLost) Serial.println(F("a sensor reading was rejected: repeat"));
  if (event == kLetGo) Serial.println(F("stopped: repeat"));
  if (event != kCurveRow) file.flush();
  has_pending = false;
  if (rows_lost > 0) Serial.println(F("the card was too slow for a row: record this run again"));
  rows_lost = 0;
  if (event != kCurveRow) announce();
}
