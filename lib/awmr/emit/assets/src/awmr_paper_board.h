/* The source paper's hardware for the example sketches: MPU9250 for heading and yaw rate, GPS for speed and
   position, a servo, two motor drivers, a log on an SD card. Arduino Mega 2560; header-only, so that
   the library itself needs neither Wire nor SD. Axes: x north, y west, z up; heading
   counter-clockwise from north. */
#ifndef AWMR_PAPER_BOARD_H
#define AWMR_PAPER_BOARD_H

#include <Arduino.h>
#include <SD.h>
#include <Wire.h>

#include "awmr.h"
#include "awmr/model/float_math.h"

namespace awmr_board {

/* Wiring */
const uint8_t kServoPin = 6;  /* OC4A: 50 Hz by timer 4 */
const uint8_t kLeftPwmPin = 44, kLeftDirectionPin = 22;   /* OC5C, by timer 5 */
const uint8_t kRightPwmPin = 45, kRightDirectionPin = 23; /* OC5B */
const uint8_t kSdSelectPin = 53;
const uint16_t kServoCentreUs = 1500;
const float kServoUsPerRad = 573.0f; /* 10 us per degree of the wheels: measure yours */

/* ---- MPU9250: gyroscope about z, magnetometer in x and y ---------------------------------- */
class Imu {
 public:
  float psi_rad = 0.0f; /* from north once has_heading() */
  float r_radps = 0.0f;
  uint32_t time_ms = 0; /* of the last good reading; 0: there was no heading yet */

  /* The magnetometer has given one: until then the heading is old, and the motors stay off. */
  bool has_heading() const { return has_heading_; }

  void begin() {
    Wire.begin();
    Wire.setClock(400000);
    write(kMpu, 0x6B, 0x01); /* awake, gyroscope's clock */
    write(kMpu, 0x1A, 0x03); /* 41 Hz low pass */
    write(kMpu, 0x1B, 0x08); /* +-500 deg/s */
    write(kMpu, 0x37, 0x02); /* magnetometer on the same bus */
    write(kMag, 0x0A, 0x16); /* 16 bit, 100 Hz */
    calibrate();
  }

  /* Integrates the gyroscope and leans on the magnetometer with a time constant of 2 s. */
  void read(float dt_s) {
    uint8_t bytes[7];
    if (!request(kMpu, 0x47, bytes, 2)) return;
    r_radps = rate(bytes) - bias_radps_;
    psi_rad += r_radps * dt_s;
    if (request(kMag, 0x02, bytes, 1) && (bytes[0] & 0x01) && request(kMag, 0x03, bytes, 7) &&
        !(bytes[6] & 0x08)) {
      lean(magnetic_heading(bytes), dt_s / 2.0f);
    }
    if (has_heading_) time_ms = millis();
  }

 private:
  static const uint8_t kMpu = 0x68;
  static const uint8_t kMag = 0x0C;
  float bias_radps_ = 0.0f;
  bool has_heading_ = false;

  static int16_t word(uint8_t high, uint8_t low) {
    return static_cast<int16_t>(static_cast<uint16_t>(high) << 8 | low);
  }
  static float rate(const uint8_t* b) { return word(b[0], b[1]) * (500.0f / 32768.0f * 0.0174532925f); }
  /* AK8963: its x is the board's y and its y the board's x. */
  static float magnetic_heading(const uint8_t* b) {
    const float ahead = word(b[3], b[2]);
    const float left = word(b[1], b[0]);
    return atan2(-left, ahead);
  }
  void lean(float measured_rad, float share) {
    if (!has_heading_) psi_rad = measured_rad;
    has_heading_ = true;
    psi_rad += share * awmr::float_math::wrapped(measured_rad - psi_rad);
  }
  /* At rest for a second: the gyroscope's mean is its bias. */
  void calibrate() {
    float sum = 0.0f;
    uint8_t bytes[2];
    uint8_t count = 0;
    for (uint8_t i = 0; i < 100; ++i, delay(10)) {
      if (!request(kMpu, 0x47, bytes, 2)) continue;
      sum += rate(bytes);
      ++count;
    }
    if (count > 0) bias_radps_ = sum / count;
  }
  static void write(uint8_t device, uint8_t address, uint8_t value) {
    Wire.beginTransmission(device);
    Wire.write(address);
    Wire.write(value);
    Wire.endTransmission();
  }
  static bool request(uint8_t device, uint8_t address, uint8_t* bytes, uint8_t count) {
    Wire.beginTransmission(device);
    Wire.write(address);
    if (Wire.endTransmission(false) != 0) return false;
    if (Wire.requestFrom(device, count) != count) return false;
    for (uint8_t i = 0; i < count; ++i) bytes[i] = static_cast<uint8_t>(Wire.read());
    return true;
  }
};

/* ---- GPS: $--RMC sentences on Serial1, 5 Hz or more --------------------------------------- */
class Gps {
 public:
  float x_m = 0.0f; /* north of the first fix */
  float y_m = 0.0f; /* west of the first fix */
  float speed_mps = 0.0f;
  uint32_t time_ms = 0; /* of the last good fix; 0: none yet */

  void begin() { Serial1.begin(38400); }

  void read() {
    while (Serial1.available() > 0) {
      const char c = static_cast<char>(Serial1.read());
      if (c == '$') length_ = 0;
      if (length_ < sizeof line_ - 1) line_[length_++] = c;
      if (c == '\n') {
        line_[length_] = '\0';
        parse();
        length_ = 0;
      }
    }
  }

 private:
  char line_[96];
  uint8_t length_ = 0;
  bool has_origin_ = false;
  int32_t origin_lat_ = 0; /* 1e-7 deg */
  int32_t origin_lon_ = 0;

  /* The characters between $ and * in exclusive or. */
  bool is_whole() const {
    uint8_t sum = 0;
    uint8_t i = 1;
    while (line_[i] != '*' && line_[i] != '\0') sum ^= static_cast<uint8_t>(line_[i++]);
    return line_[0] == '$' && line_[i] == '*' && strtoul(line_ + i + 1, 0, 16) == sum;
  }
  /* [d]ddmm.mmmm in 1e-7 deg, in whole numbers: a float has too few digits. */
  static int32_t degrees_e7(const char* field) {
    uint32_t whole = 0;
    uint32_t part = 0;
    uint32_t scale = 1000000;
    while (*field >= '0' && *field <= '9') whole = whole * 10 + static_cast<uint32_t>(*field++ - '0');
    if (*field == '.') ++field;
    for (; *field >= '0' && *field <= '9' && scale > 0; scale /= 10) {
      part += static_cast<uint32_t>(*field++ - '0') * scale;
    }
    const uint32_t minutes_e7 = whole % 100 * 10000000UL + part;
    return static_cast<int32_t>(whole / 100 * 10000000UL + minutes_e7 / 60);
  }
  /* $GPRMC,time,A,lat,N,lon,E,knots,course,date,... */
  void parse() {
    if (!is_whole() || strncmp(line_ + 3, "RMC", 3) != 0) return;
    const char* fields[9];
    uint8_t count = 0;
    for (const char* at = line_; *at != '\0' && count < 9; ++at) {
      if (*at == ',') fields[count++] = at + 1;
    }
    if (count < 9 || *fields[1] != 'A') return;
    const int32_t lat = *fields[3] == 'S' ? -degrees_e7(fields[2]) : degrees_e7(fields[2]);
    const int32_t lon = *fields[5] == 'W' ? -degrees_e7(fields[4]) : degrees_e7(fields[4]);
    if (!has_origin_) {
      origin_lat_ = lat;
      origin_lon_ = lon;
      has_origin_ = true;
    }
    const float m_per_e7 = 0.0111319491f; /* of a great circle of 6378137 m */
    x_m = static_cast<float>(lat - origin_lat_) * m_per_e7;
    y_m = static_cast<float>(origin_lon_ - lon) * m_per_e7 *
          cos(static_cast<float>(lat) * 1.74532925e-9f);
    speed_mps = static_cast<float>(atof(fields[6])) * 0.514444444f;
    time_ms = millis();
  }
};

/* ---- Servo and motors --------------------------------------------------------------------- */
inline void begin_actuators() {
  pinMode(kServoPin, OUTPUT);
  pinMode(kLeftPwmPin, OUTPUT);
  pinMode(kLeftDirectionPin, OUTPUT);
  pinMode(kRightPwmPin, OUTPUT);
  pinMode(kRightDirectionPin, OUTPUT);
  /* Timer 4, fast PWM to ICR4, clock/8: half a microsecond a count, 20 ms a period. */
  TCCR4A = _BV(COM4A1) | _BV(WGM41);
  TCCR4B = _BV(WGM43) | _BV(WGM42) | _BV(CS41);
  ICR4 = 39999;
  OCR4A = 2 * kServoCentreUs;
}

inline void drive_motor(uint8_t pwm_pin, uint8_t direction_pin, float force) {
  digitalWrite(direction_pin, force < 0.0f ? HIGH : LOW);
  const float size = force < 0.0f ? -force : force;
  analogWrite(pwm_pin, static_cast<int>(255.0f * size + 0.5f));
}

inline void drive(const awmr_output& out) {
  OCR4A = static_cast<uint16_t>(2.0f * (kServoCentreUs + kServoUsPerRad * out.steering_rad));
  drive_motor(kLeftPwmPin, kLeftDirectionPin, out.force_left);
  drive_motor(kRightPwmPin, kRightDirectionPin, out.force_right);
}

/* ---- Log: what `awmr identify --log` reads ------------------------------------------------- */
class Log {
 public:
  bool begin() {
    if (!SD.begin(kSdSelectPin)) return false;
    char name[] = "LOG00.CSV";
    for (uint8_t i = 0; i < 100; ++i) {
      name[3] = static_cast<char>('0' + i / 10);
      name[4] = static_cast<char>('0' + i % 10);
      if (!SD.exists(name)) break;
    }
    file_ = SD.open(name, FILE_WRITE);
    if (!file_) return false;
    file_.println(F("t_s,force_left,force_right,steering_cmd_deg,x_m,y_m,heading_deg,speed_mps,"
                    "yaw_rate_radps,fault"));
    return true;
  }

  void write(const awmr_input& in, const awmr_output& out) {
    if (!file_) return;
    file_.print(static_cast<float>(in.now_ms) * 1e-3f, 3);
    const float values[] = {out.force_left, out.force_right, out.steering_rad * 57.2957795f, in.x_m,
                            in.y_m, in.psi_rad * 57.2957795f, in.u_mps, in.r_radps};
    for (uint8_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
      file_.print(',');
      file_.print(values[i], 4);
    }
    file_.print(',');
    file_.println(out.fault);
    if (++rows_ % 50 == 0) file_.flush();
  }

 private:
  File file_;
  uint16_t rows_ = 0;
};

}  // namespace awmr_board

#endif /* AWMR_PAPER_BOARD_H */
