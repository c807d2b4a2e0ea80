// Guides through the first test of a vehicle after flashing ("From the first flash to a drive" in
// README.md), with the wheels off the ground. Over Serial (115200 baud) the sketch announces each
// motion. The line "y" starts this motion, any other line means no. The first no ends the test,
// with the motors off until a reset: fix the fault and start again. Forces are at most kForce, a
// motion lasts two seconds, and any character during a motion also ends the test.
#include <Wire.h>
#include <awmr.h>
#include <awmr_paper_board.h>

const float kForce = 0.2f * AWMR_WHEEL_FORCE_MAX;
const float kAngleRad = 0.5f * AWMR_STEERING_MAX_RAD;

awmr_board::Imu imu;
awmr_input input;
Stream* gps_port;
awmr::RmcReader gps_reader;
volatile bool has_fix = false;

// Commands that the control step executes. setup() and want() set them with interrupts off, because
// the timer interrupt could read a float of which only some of the four bytes are new.
struct Wanted {
  float left, right, steering_rad;
  // true: the autopilot holds the heading, with at most kForce, and the commands above are unused
  bool by_autopilot;
};
Wanted wanted;
awmr_output output;
volatile bool shall_hang = false;
float turned_rad = 0.0f; // integral of the yaw rate since a test set it to 0

float cut(float force) { return constrain(force, -kForce, kForce); }

void receive() {
  while (gps_port->available() > 0) {
    if (!gps_reader.take(static_cast<char>(gps_port->read()))) continue;
    if (gps_reader.kind() == awmr::GpsSentence::kFix) has_fix = true;
  }
}

// True for the line "y" and nothing else.
bool read_yes() {
  bool is_yes = false;
  for (uint8_t length = 0;;) {
    if (Serial.available() == 0) continue;
    const char c = static_cast<char>(Serial.read());
    if (c != '\n' && c != '\r') {
      is_yes = length == 0 && (c == 'y' || c == 'Y');
      if (length < 255) ++length;
    } else if (length > 0) {
      return is_yes && length == 1;
    }
  }
}

void step() {
  imu.read(AWMR_SAMPLE_TIME_S);
  turned_rad += imu.r_radps * AWMR_SAMPLE_TIME_S;
  while (shall_hang) {
  }
  if (wanted.by_autopilot) {
    input.now_ms = millis();
    input.psi_rad = imu.psi_rad;
    input.r_radps = imu.r_radps;
    input.heading_ms =
        awmr_board::time_or_old(imu.has_heading(), imu.time_ms, input.now_ms, AWMR_HEADING_TIMEOUT_MS);
    // The wheels are off the ground: the vehicle has speed 0 and needs no GPS fix. Current time
    // stamps keep the autopilot from reporting old inputs.
    input.speed_ms = input.command_ms = input.now_ms;
    awmr_step(&input, &output);
    output.force_left = cut(output.force_left);
    output.force_right = cut(output.force_right);
  } else {
    output = awmr_output();
    output.force_left = wanted.left;
    output.force_right = wanted.right;
    output.steering_rad = wanted.steering_rad;
  }
  awmr_board::drive(output);
}

void want(float left, float right, float steering_rad, bool by_autopilot = false) {
  const Wanted next = {left, right, steering_rad, by_autopilot};
  noInterrupts();
  wanted = next;
  interrupts();
}

float atomically(const float& value) {
  noInterrupts();
  const float copy = value;
  interrupts();
  return copy;
}

void end(const __FlashStringHelper* why) {
  want(0.0f, 0.0f, 0.0f);
  Serial.print(F("ENDED: "));
  Serial.println(why);
  for (;;) {
  }
}

void prompt(const __FlashStringHelper* question) {
  Serial.print(question);
  Serial.println(F("  y?"));
  if (!read_yes()) end(question);
}

// Waits for limit_ms. A character that arrives meanwhile ends the test.
void wait_ms(uint32_t limit_ms) {
  const uint32_t start_ms = millis();
  while (Serial.available() > 0) Serial.read(); // rest of the last line
  while (millis() - start_ms < limit_ms) {
    if (Serial.available() > 0) end(F("stopped"));
  }
}

// Moves actuators for two seconds, then asks the user what was observed.
void show(float left, float right, float steering_rad, const __FlashStringHelper* warning,
          const __FlashStringHelper* question) {
  prompt(warning);
  want(left, right, steering_rad);
  wait_ms(2000);
  want(0.0f, 0.0f, 0.0f);
  prompt(question);
}

// Waits until the gyroscope is calibrated, which takes a second at rest. Ends the test after 10 s.
void wait_still() {
  const uint32_t start_ms = millis();
  while (imu.fault() == awmr::kGyroNotCalibrated) {
    if (millis() - start_ms > 10000) end(F("not at rest for a second, or the gyroscope's offset is too large"));
  }
}

void check_turn() {
  prompt(F("2. Next: lift the robot and turn it LEFT by a quarter turn, within 20 s."));
  wait_still();
  if (!imu.has_heading()) end(F("no heading: magnetometer or its wiring"));
  const float before = atomically(imu.psi_rad);
  noInterrupts();
  turned_rad = 0.0f;
  interrupts();
  const uint32_t start_ms = millis();
  while (fabs(atomically(turned_rad)) < 1.2f) {
    if (millis() - start_ms > 20000) end(F("no turn was seen: gyroscope or its wiring"));
  }
  if (atomically(turned_rad) < 0.0f) end(F("gyroscope of the wrong sign: is it upside down?"));
  delay(6000); // three time constants with which the compass corrects the heading
  const float turned = awmr::float_math::wrapped(atomically(imu.psi_rad) - before);
  Serial.print(F("turned by the compass, deg: "));
  Serial.println(turned * 57.2957795f, 0);
  if (turned < 0.8f) end(F("compass and gyroscope differ: check axes, calibrate the compass"));
}

void check_autopilot() {
  prompt(F("8. Next: the autopilot holds the heading, wheels in the air. Turn the robot 30 deg LEFT by hand."));
  noInterrupts();
  input.mode = AWMR_COMBINED;
  input.psi_ref_rad = imu.psi_rad;
  turned_rad = 0.0f;
  wanted.by_autopilot = true;
  interrupts();
  for (uint8_t i = 0; i < 100 && atomically(turned_rad) < 0.35f; ++i) wait_ms(200);
  noInterrupts();
  const awmr_output seen = output;
  const float turned = turned_rad;
  interrupts();
  want(0.0f, 0.0f, 0.0f);
  if (turned < 0.35f) end(F("no turn was seen"));
  if (seen.fault != AWMR_FAULT_NONE) end(F("the autopilot reports a fault: awmr.h"));
  const bool turns_right = seen.steering_rad < 0.0f || seen.force_right < seen.force_left;
  if (!turns_right) end(F("the autopilot does not turn back: signs"));
}

void walk() {
  prompt(F("1. Wheels off the ground, a hand at the battery's plug, nobody near the wheels."));
  check_turn();
  show(0.0f, 0.0f, kAngleRad, F("3. Next: the front wheels turn LEFT."), F("   Did they turn left, by half of the stop?"));
  show(0.0f, 0.0f, -kAngleRad, F("   Next: RIGHT."), F("   Right?"));
  show(kForce, 0.0f, 0.0f, F("4. Next: the LEFT wheels turn forward."), F("   The left ones, and forward?"));
  show(0.0f, kForce, 0.0f, F("5. Next: the RIGHT wheels turn forward."), F("   The right ones, and forward?"));
  if (AWMR_WHEEL_FORCE_MIN < 0.0f) {
    show(-kForce, -kForce, 0.0f, F("   Next: all wheels turn BACKWARD."), F("   All, and backward?"));
  }
  prompt(F("6. GPS: under the open sky. Is its light on?"));
  const uint32_t start_ms = millis();
  while (!has_fix && millis() - start_ms < 60000) {
  }
  if (!has_fix) end(F("no fix within a minute"));
#if AWMR_BOARD_HAS_CARD
  if (!SD.begin(awmr_board::kSdSelectPin)) end(F("7. no SD card"));
#endif
  check_autopilot();
  prompt(F("9. Next: wheels turn, the program hangs. The motors must stop within 1 s and this sketch must restart."));
  want(kForce, kForce, 0.0f);
  wait_ms(1000);
  shall_hang = true;
  delay(3000);
  end(F("the watchdog did not reset"));
}

void setup() {
  Serial.begin(115200);
  awmr_board::begin_actuators();
  imu.begin();
  gps_port = &awmr_board::begin_gps_port();
  const bool was_reset = (awmr_board::reset_cause() & awmr_board::kWatchdog) != 0;
  if (awmr_init() != AWMR_FAULT_NONE) Serial.println(F("parameters damaged: flash again"));
  awmr_board::begin_steps(receive, step);
  if (was_reset) Serial.println(F("9. The watchdog works. The test is done. Repeat it?"));
  walk();
}

void loop() {}
