/* MPU9250: gyroscope about z, magnetometer in x and y, without tilt compensation: the board must be
   level. */
#ifndef AWMR_BOARD_IMU_H
#define AWMR_BOARD_IMU_H

#include <math.h>

#include "../awmr/emit/board/heading_check.h"
#include "../awmr/model/float_bearing.h"
#include "../awmr_params.h"

/* `awmr compass` writes src/awmr_compass.h from the records of the sketch CompassCalibration. */
#ifdef __has_include
#if __has_include("../awmr_compass.h")
#include "../awmr_compass.h"
#endif
#endif
#ifndef AWMR_COMPASS_CALIBRATED
#define AWMR_COMPASS_CALIBRATED 0
#define AWMR_COMPASS_AHEAD_0 0.0f
#define AWMR_COMPASS_LEFT_0 0.0f
#define AWMR_COMPASS_AHEAD_AHEAD 1.0f
#define AWMR_COMPASS_AHEAD_LEFT 0.0f
#define AWMR_COMPASS_LEFT_LEFT 1.0f
#define AWMR_COMPASS_DECLINATION_RAD 0.0f
#endif

namespace awmr_board {

class Imu {
 public:
  /* heading, counter-clockwise from true north, in (-pi, pi]; valid once has_heading() */
  float psi_rad = 0.0f;
  float r_radps = 0.0f; /* yaw rate, counter-clockwise positive */
  uint32_t time_ms = 0; /* time of the last accepted reading, valid once has_heading() */
  float field_ahead = 0.0f; /* the last magnetic field forward, raw counts of the sensor */
  float field_left = 0.0f;  /* the last magnetic field to the left */
  uint32_t field_ms = 0;    /* time of this field; 0: none yet */

  /* True once the gyroscope is calibrated and the magnetometer has given a heading. Until then the
     autopilot treats the heading as too old, and the motors stay off. */
  bool has_heading() const { return has_heading_; }

  /* Reason why heading and yaw rate are rejected; awmr::kSensorGood: they are accepted. */
  awmr::SensorFault fault() const { return check_.fault(millis()); }

  void begin() {
    Wire.begin();
    Wire.setClock(400000);
#ifdef WIRE_HAS_TIMEOUT
    Wire.setWireTimeout(3000, true); /* us: resets a bus that hangs */
#endif
    write(kMpu, 0x6B, 0x01); /* awake, gyroscope's clock */
    write(kMpu, 0x1A, 0x03); /* 41 Hz low pass */
    write(kMpu, kRangeRegister, kRange);
    write(kMpu, 0x37, 0x02); /* magnetometer on the same bus */
    read_sensitivity();
    write(kMag, 0x0A, 0x16); /* 16 bit, 100 Hz */
    check_.begin(millis());
    check_.turn.begin(kRadpsPerWord, AWMR_SAMPLE_TIME_S);
  }

  /* Call after awmr_step() with the yaw moment (divided by F_max, m) that is commanded until the
     next step; 0 if the motors are off. read() compares the sign of the yaw rate with it. */
  void note_moment(float tau_turn_m) { moment_m_ = tau_turn_m; }

  /* Call in the step: integrates the gyroscope and corrects it by the magnetometer (time constant 2
     s). The first 100 readings at rest calibrate the gyroscope. */
  void read(float dt_s) {
    const uint32_t now_ms = millis();
    const bool has_field = read_field(now_ms);
    const float magnetic_rad =
        has_field ? magnetic_heading() - AWMR_COMPASS_DECLINATION_RAD : 0.0f;
    uint8_t bytes[2];
    if (!request(kMpu, 0x47, bytes, 2)) return;
    const int16_t raw = word(bytes[0], bytes[1]);
    check_.take_gyro(raw, now_ms);
    if (++steps_ >= kStepsPerCheck) {
      steps_ = 0;
      if (request(kMpu, kRangeRegister, bytes, 1)) check_.take_range(bytes[0] == kRange);
    }
    if (!check_.calibration.is_done()) {
      check_.calibration.take(raw, kRadpsPerWord, has_field, magnetic_rad);
      r_radps = 0.0f;
      return;
    }
    check_.turn.take(static_cast<int16_t>(raw - check_.calibration.bias_word()), moment_m_);
    r_radps = kRadpsPerWord * raw - check_.calibration.bias_radps();
    psi_rad = awmr::float_math::wrapped(psi_rad + r_radps * dt_s);
    if (has_field) correct(magnetic_rad, dt_s);
    if (has_heading_ && check_.fault(now_ms) == awmr::kSensorGood) time_ms = now_ms;
  }

 private:
  static const uint8_t kMpu = 0x68;
  static const uint8_t kMag = 0x0C;
  static const uint8_t kRangeRegister = 0x1B;
  static const uint8_t kRange = 0x08; /* +-500 deg/s */
  static const uint8_t kStepsPerCheck = 5;
  static constexpr float kRadpsPerWord = 500.0f / 32768.0f * 0.0174532925f;
  static constexpr float kCorrection_s = 2.0f;
  awmr::HeadingCheck check_;
  float sensitivity_[2] = {0.0f, 0.0f}; /* factors of the magnetometer's x and y, by
                                           read_sensitivity() */
  bool has_heading_ = false;
  uint8_t steps_ = 0;
  float moment_m_ = 0.0f;

  static int16_t word(uint8_t high, uint8_t low) {
    return static_cast<int16_t>(static_cast<uint16_t>(high) << 8 | low);
  }
  /* Reads the magnetic field. False, with the field unchanged, if the reading is not new, out of
     the sensor's range, or zero. */
  bool read_field(uint32_t now_ms) {
    uint8_t bytes[7];
    if (!request(kMag, 0x02, bytes, 1) || (bytes[0] & 0x01) == 0) return false;
    if (!request(kMag, 0x03, bytes, 7) || (bytes[6] & 0x08) != 0) return false;
    const int16_t x = word(bytes[1], bytes[0]);
    const int16_t y = word(bytes[3], bytes[2]);
    if (x == 0 && y == 0) return false;
    check_.take_field(x, y, word(bytes[5], bytes[4]), now_ms);
    /* The magnetometer AK8963 is mounted with its x along the board's y and its y along the board's
       x. */
    field_ahead = sensitivity_[1] * y;
    field_left = sensitivity_[0] * x;
    field_ms = now_ms;
    return true;
  }
  /* Returns the heading, counter-clockwise from magnetic north: the angle of the vector (a, -l),
     where (a, l) = S (field - centre) is the calibrated field ahead and to the left. */
  float magnetic_heading() const {
    const float ahead = field_ahead - AWMR_COMPASS_AHEAD_0;
    const float left = field_left - AWMR_COMPASS_LEFT_0;
    return awmr::float_math::bearing(
        -(AWMR_COMPASS_AHEAD_LEFT * ahead + AWMR_COMPASS_LEFT_LEFT * left),
        AWMR_COMPASS_AHEAD_AHEAD * ahead + AWMR_COMPASS_AHEAD_LEFT * left);
  }
  void correct(float measured_rad, float dt_s) {
    if (!has_heading_) psi_rad = awmr::float_math::wrapped(measured_rad);
    has_heading_ = true;
    const float innovation = awmr::float_math::wrapped(measured_rad - psi_rad);
    check_.step.take(innovation, dt_s);
    psi_rad = awmr::float_math::wrapped(psi_rad + dt_s / kCorrection_s * innovation);
  }
  /* Reads the manufacturer's sensitivity factors: H_adjusted = H ((ASA - 128)/256 + 1).
     [AK8963 data sheet, 8.3.11] */
  void read_sensitivity() {
    uint8_t bytes[3];
    sensitivity_[0] = sensitivity_[1] = 1.0f; /* used if they cannot be read */
    write(kMag, 0x0A, 0x00);
    delay(1);
    write(kMag, 0x0A, 0x0F); /* fuse ROM */
    delay(1);
    if (request(kMag, 0x10, bytes, 3)) {
      for (uint8_t i = 0; i < 2; ++i) sensitivity_[i] = (bytes[i] - 128) / 256.0f + 1.0f;
    }
    write(kMag, 0x0A, 0x00);
    delay(1);
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

}  // namespace awmr_board

#endif /* AWMR_BOARD_IMU_H */
