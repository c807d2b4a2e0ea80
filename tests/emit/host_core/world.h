// Simulated vehicle, sensors and operator for the emitted sketches. Every quantity that a test case
// modifies is a member.
#pragma once
#include <Arduino.h>
#include <SD.h>
#include <Wire.h>
#include <awmr.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <random>
#include <vector>

// awmr_params.h of a power law lacks the terms of the other resistance families.
#ifndef AWMR_SURGE_COULOMB
#define AWMR_SURGE_COULOMB 0.0
#endif
#ifndef AWMR_SURGE_QUADRATIC
#define AWMR_SURGE_QUADRATIC 0.0
#endif
#ifndef AWMR_YAW_COULOMB
#define AWMR_YAW_COULOMB 0.0
#endif
#ifndef AWMR_YAW_QUADRATIC
#define AWMR_YAW_QUADRATIC 0.0
#endif

Stream Serial, Serial1;
TwoWire Wire;
SDClass SD;
uint16_t OCR4A, ICR4, TCNT3, OCR3A = 65535;
uint8_t TCCR4A, TCCR4B, TCCR3A, TCCR3B, TIMSK3, MCUSR = 1;
extern "C" void TIMER3_COMPA_vect();
void setup();
void loop();

struct World {
  // Time, ms: of millis() at the start, since the start, and between two control steps.
  uint32_t start_ms = 1000, elapsed_ms = 0;
  const uint32_t step_ms = static_cast<uint32_t>(lround(1000.0 * AWMR_SAMPLE_TIME_S));
  uint32_t timer_ms = 0;  // when the timer started
  // Motion in m, rad, s, and differences of the vehicle from the model.
  double x = 0, y = 0, psi = 0.3, u = 0, r = 0;
  double mass_factor = 1, drag_factor = 1, motor_sign = 1, slope = 0;
  bool sides_swapped = false;
  double left_gain = 1, right_gain = 1;
  double left_stuck = NAN;  // constant force of a defective left motor; NAN: it works
  double motor_lag_s = 0, left_force = 0, right_force = 0;
  double servo_sign = 1, servo_offset = 0, servo_lag_s = 0, servo_stuck = NAN, servo_rad = 0;
  double forced_turn = 0;  // rad/s: somebody turns the vehicle by hand
  bool is_held = false;    // somebody holds the vehicle: u is 0
  std::map<int, int> duty, level;
  // Sensors.
  std::mt19937 random{7};
  double gyro_bias = 0.02, gyro_gain = 1, gyro_noise = 5, compass_offset = 0, compass_noise = 3;
  double compass_rate = 0;  // rad/s: the compass offset grows, as if the compass turned
  double compass_ahead_sign = 1, compass_left_sign = 1, compass_distortion = 0;
  bool compass_axes_swapped = false;
  bool gyro_answers = true, gyro_frozen = false, compass_answers = true, compass_frozen = false;
  bool compass_stuck = false;
  double stuck_psi = 0;
  double hard_iron = 0;  // counts that iron near the compass adds to the field to the left
  std::map<int, int> registers;
  int gyro_word = 0, field[3] = {0, 0, 0};
  double gps_noise_m = 0.1, gps_speed_noise = 0.05, gps_jump_m = 0, gps_speed_gain = 1;
  double gps_wander_m = 0, wander_x = 0, wander_y = 0;
  double gps_speed_stuck = NAN;                 // constant speed of all fixes, m/s; NAN: true
  uint32_t gps_period_ms = 200, utc_s = 43200;  // between two fixes; time of day at the start
  uint32_t gps_delay_ms = 0, gps_latency_ms = 0;
  bool gps_answers = true, gps_repeats = false, gps_empty = false, gps_void = false,
       gps_still = false, gps_west_still = false;
  double still_x = 0, still_y = 0;
  bool gps_bad_sum = false;
  std::string last_sentence;
  std::deque<std::pair<uint32_t, std::string>> on_the_way;
  int reversals = 0, driven_reversals = 0;  // changes of a direction pin; of these, with PWM on
  // Operator.
  bool keeps = true;
  uint32_t keep_period_ms = 300;
  std::string keep = "KEEP\n";
  int sequence = 0;
  // Called every ms; a test sets it to a failure that changes with time.
  std::function<void(World&)> each_ms = [](World&) {};

  double noise(double sigma) { return std::normal_distribution<double>(0, sigma)(random); }
  double force(int pwm, int direction) {
    return motor_sign * duty[pwm] / 255.0 * (level[direction] ? -1 : 1);
  }
  // True if the left wheels get the force of the right motor. Reversed motors are mounted on
  // exchanged sides, so that the vehicle drives the wrong way but turns as commanded.
  bool is_exchanged() const { return (motor_sign < 0) != sides_swapped; }
  double left() {
    if (!std::isnan(left_stuck)) return left_stuck;
    return left_gain * (is_exchanged() ? force(45, 23) : force(44, 22));
  }
  double right() { return right_gain * (is_exchanged() ? force(44, 22) : force(45, 23)); }
  bool is_driven() { return duty[44] != 0 || duty[45] != 0; }
  double steering() const {
    return std::isnan(servo_stuck) ? servo_sign * (OCR4A / 2.0 - 1500) / 573.0 + servo_offset
                                   : servo_stuck;
  }
  // Moves `from` towards `to` over `dt` by a first-order lag; at once for a time constant of 0.
  static double lagged(double from, double to, double dt, double time_constant_s) {
    return time_constant_s > 0 ? from + dt / time_constant_s * (to - from) : to;
  }
  static double surge_drag(double w) {
    return AWMR_SURGE_COULOMB + AWMR_SURGE_ALPHA * pow(fabs(w), AWMR_SURGE_BETA) +
           AWMR_SURGE_QUADRATIC * w * w;
  }
  static double yaw_drag(double w) {
    return AWMR_YAW_COULOMB + AWMR_YAW_ALPHA * pow(fabs(w), AWMR_YAW_BETA) +
           AWMR_YAW_QUADRATIC * w * w;
  }

  void move(double dt) {
    left_force = lagged(left_force, left(), dt, motor_lag_s);
    right_force = lagged(right_force, right(), dt, motor_lag_s);
    servo_rad = lagged(servo_rad, steering(), dt, servo_lag_s);
    const double d = servo_rad, sum = left_force + right_force;
    const double thrust = sum * (1 + cos(d));
    const double mass = mass_factor * AWMR_MASS_NORM;
    double next = u + dt * (thrust - slope) / mass;
    const double loss = dt * drag_factor * surge_drag(next) / mass;
    u = fabs(next) > loss ? next - copysign(loss, next) : 0;
    const double moment = AWMR_FRONT_AXLE_M * sum * sin(d) +
                          AWMR_HALF_TRACK_M * (right_force - left_force) * (1 + cos(d));
    next = r + dt * moment / AWMR_INERTIA_NORM;
    const double turn = dt * drag_factor * yaw_drag(next) / AWMR_INERTIA_NORM;
    r = fabs(next) > turn ? next - copysign(turn, next) : 0;
    if (forced_turn != 0) r = forced_turn;
    if (is_held) u = 0;
    psi += dt * r;
    x += dt * u * cos(psi);
    y += dt * u * sin(psi);
  }
  void sense() {
    if (!gyro_frozen) {
      gyro_word = static_cast<int>(
          lround(gyro_gain * (r + gyro_bias) * 32768 / 500 * 57.29578 + noise(gyro_noise)));
    }
    if (compass_frozen) return;
    const double seen =
        (compass_stuck ? stuck_psi : psi + compass_offset) + compass_distortion * sin(2 * psi);
    field[0] = static_cast<int>(
        lround(compass_left_sign * -250 * sin(seen) + hard_iron + noise(compass_noise)));
    field[1] =
        static_cast<int>(lround(compass_ahead_sign * 250 * cos(seen) + noise(compass_noise)));
    if (compass_axes_swapped) std::swap(field[0], field[1]);
    field[2] = static_cast<int>(lround(400 + noise(compass_noise)));
  }
  void navigate() {
    if (elapsed_ms % gps_period_ms == 0 && gps_answers) {
      if (!gps_repeats || last_sentence.empty()) last_sentence = sentence();
      on_the_way.push_back({elapsed_ms + gps_delay_ms, last_sentence});
    }
    while (!on_the_way.empty() && on_the_way.front().first <= elapsed_ms) {
      for (const char c : on_the_way.front().second) Serial1.incoming.push_back(c);
      on_the_way.pop_front();
    }
  }
  std::string sentence() {
    if (gps_wander_m > 0) {
      // Slowly varying errors of the GPS position, with a correlation time of a minute.
      for (double* wander : {&wander_x, &wander_y}) {
        *wander += noise(gps_wander_m * sqrt(2 * 0.2 / 60)) - 0.2 / 60 * *wander;
      }
    }
    const double px = gps_still ? still_x : x + gps_jump_m + wander_x + noise(gps_noise_m);
    const double py = gps_still || gps_west_still ? still_y : y + wander_y + noise(gps_noise_m);
    const double lat = 48.1 + px / 111319.491,
                 lon = 11.5 - py / (111319.491 * cos(48.1 * 0.0174532925));
    const double seen_mps = fabs(gps_speed_gain * u + noise(gps_speed_noise));
    const double knots = (std::isnan(gps_speed_stuck) ? seen_mps : gps_speed_stuck) / 0.514444444;
    const auto degrees = [](double v, int digits) {
      char text[32];
      snprintf(text, sizeof text, "%0*d%010.7f", digits, static_cast<int>(v),
               (v - static_cast<int>(v)) * 60);
      return std::string(text);
    };
    const unsigned s = (utc_s + elapsed_ms / 1000) % 86400;
    char body[160];
    if (gps_empty) {
      snprintf(body, sizeof body, "GPRMC,%02u%02u%02u.%02u,A,,,,,,,230394,,,A", s / 3600,
               s / 60 % 60, s % 60, elapsed_ms % 1000 / 10);
    } else {
      snprintf(body, sizeof body, "GPRMC,%02u%02u%02u.%02u,%c,%s,N,%s,E,%.3f,,230394,,,A", s / 3600,
               s / 60 % 60, s % 60, elapsed_ms % 1000 / 10, gps_void ? 'V' : 'A',
               degrees(lat, 2).c_str(), degrees(lon, 3).c_str(), knots);
    }
    unsigned sum = 0;
    for (const char* c = body; *c; ++c) sum ^= static_cast<unsigned char>(*c);
    if (gps_bad_sum) sum ^= 1;
    char text[200];
    snprintf(text, sizeof text, "$%s*%02X\r\n", body, sum);
    return text;
  }
  void say(const std::string& text) {
    for (const char c : text) Serial.incoming.push_back(c);
  }
  // Simulates the serial lines and timer 3 (2 counts per us) over the millisecond that ends now:
  // calls the timer's interrupt at its times.
  void pass_time() {
    const uint32_t period = OCR3A + 1U;
    const uint64_t end = 2000ULL * (elapsed_ms - timer_ms);
    double passed = 0;
    for (uint64_t at = (end - 2000) / period * period + period; at <= end; at += period) {
      const double to = 1 - static_cast<double>(end - at) / 2000;
      pass_lines(to - passed);
      passed = to;
      TIMER3_COMPA_vect();
    }
    pass_lines(1 - passed);
  }
  static void pass_lines(double ms) {
    Serial.pass(ms);
    Serial1.pass(ms);
  }
  void tick() {
    ++elapsed_ms;
    each_ms(*this);
    compass_offset += 0.001 * compass_rate;
    move(0.001);
    navigate();
    if (keeps && elapsed_ms % keep_period_ms == 0) say(keep);
    if (TCNT3 == 0) {  // begin_steps() has started the timer
      TCNT3 = 1;
      timer_ms = elapsed_ms - 1;
    }
    const bool is_due = (elapsed_ms - timer_ms) % step_ms == 0;
    if (is_due) sense();
    pass_time();
    if (is_due) loop();
  }
  void run(double seconds, const std::function<void()>& each = {}) {
    for (int i = 0; i < static_cast<int>(seconds * 1000 + 0.5); ++i) {
      tick();
      if (each) each();
    }
  }
};
static World world;

uint32_t millis() { return world.start_ms + world.elapsed_ms; }
void delay(uint32_t ms) {
  for (; ms > 0; --ms) {
    ++world.elapsed_ms;
    world.move(0.001);
    if (world.elapsed_ms % world.step_ms == 0) world.sense();
  }
}
void pinMode(uint8_t, uint8_t) {}
void digitalWrite(uint8_t pin, uint8_t level) {
  const int pwm = pin == 22 ? 44 : pin == 23 ? 45 : -1;
  if (pwm >= 0 && level != world.level[pin]) {
    ++world.reversals;
    if (world.duty[pwm] != 0) ++world.driven_reversals;
  }
  world.level[pin] = level;
}
int digitalRead(uint8_t pin) { return world.level[pin]; }
void analogWrite(uint8_t pin, int duty) { world.duty[pin] = duty; }

static uint8_t bus_device, bus_address;
static std::vector<uint8_t> bus_written, bus_read;
static bool answers(uint8_t device) {
  return device == 0x68 ? world.gyro_answers : device == 0x0C && world.compass_answers;
}
void TwoWire::beginTransmission(uint8_t device) {
  bus_device = device;
  bus_written.clear();
}
size_t TwoWire::write(uint8_t byte) {
  bus_written.push_back(byte);
  return 1;
}
uint8_t TwoWire::endTransmission(bool) {
  if (!answers(bus_device)) return 2;
  if (!bus_written.empty()) bus_address = bus_written[0];
  for (size_t i = 1; i < bus_written.size(); ++i) {
    world.registers[bus_device << 8 | (bus_address + static_cast<int>(i) - 1)] = bus_written[i];
  }
  return 0;
}
uint8_t TwoWire::requestFrom(uint8_t device, uint8_t count) {
  bus_read.clear();
  if (!answers(device)) return 0;
  for (uint8_t i = 0; i < count; ++i) {
    const int at = bus_address + i;
    int value = world.registers[device << 8 | at];
    if (device == 0x68 && at == 0x47) value = world.gyro_word >> 8;
    if (device == 0x68 && at == 0x48) value = world.gyro_word;
    if (device == 0x0C && at == 0x02) value = 1;
    if (device == 0x0C && at >= 0x03 && at <= 0x08)
      value = world.field[(at - 3) / 2] >> (at % 2 == 1 ? 0 : 8);
    if (device == 0x0C && at >= 0x10) value = 128;
    bus_read.push_back(static_cast<uint8_t>(value));
  }
  return count;
}
int TwoWire::read() {
  if (bus_read.empty()) return -1;
  const int byte = bus_read.front();
  bus_read.erase(bus_read.begin());
  return byte;
}
