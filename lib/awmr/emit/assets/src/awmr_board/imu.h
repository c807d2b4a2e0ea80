/* MPU9250: gyroscope about z, magnetometer in x and y, for a board that lies level. */
#ifndef AWMR_BOARD_IMU_H
#define AWMR_BOARD_IMU_H

#include <math.h>

#include "../awmr/model/float_math.h"

/* `awmr compass` writes src/awmr_compass.h from what the sketch CompassCalibration records. */
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
  float psi_rad = 0.0f; /* from true north once has_heading() */
  float r_radps = 0.0f;
  uint32_t time_ms = 0; /* of the last good reading; 0: there was no heading yet */
  float field_ahead = 0.0f; /* the last magnetic field, in counts, as the sensor gives it */
  float field_left = 0.0f;
  uint32_t field_ms = 0; /* when; 0: none yet */

  /* The magnetometer has given one: until then the heading is old, and the motors stay off. */
  bool has_heading() const { return has_heading_; }

  void begin() {
    Wire.begin();
    Wire.setClock(400000);
#ifdef WIRE_HAS_TIMEOUT
    Wire.setWireTimeout(3000, true); /* us: a bus that hangs is reset */
#endif
    write(kMpu, 0x6B, 0x01); /* awake, gyroscope's clock */
    write(kMpu, 0x1A, 0x03); /* 41 Hz low pass */
    write(kMpu, 0x1B, 0x08); /* +-500 deg/s */
    write(kMpu, 0x37, 0x02); /* magnetometer on the same bus */
    read_sensitivity();
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
      /* AK8963: its x is the board's y and its y the board's x. */
      field_ahead = sensitivity_[1] * word(bytes[3], bytes[2]);
      field_left = sensitivity_[0] * word(bytes[1], bytes[0]);
      field_ms = millis();
      lean(magnetic_heading() - AWMR_COMPASS_DECLINATION_RAD, dt_s / 2.0f);
    }
    if (has_heading_) time_ms = millis();
  }

 private:
  static const uint8_t kMpu = 0x68;
  static const uint8_t kMag = 0x0C;
  float bias_radps_ = 0.0f;
  float sensitivity_[2] = {1.0f, 1.0f}; /* of the magnetometer's own x and y */
  bool has_heading_ = false;

  static int16_t word(uint8_t high, uint8_t low) {
    return static_cast<int16_t>(static_cast<uint16_t>(high) << 8 | low);
  }
  static float rate(const uint8_t* b) { return word(b[0], b[1]) * (500.0f / 32768.0f * 0.0174532925f); }
  /* (a, l) = S (field - centre), a circle; counter-clockwise from magnetic north: atan2(-l, a) */
  float magnetic_heading() const {
    const float ahead = field_ahead - AWMR_COMPASS_AHEAD_0;
    const float left = field_left - AWMR_COMPASS_LEFT_0;
    return atan2(-(AWMR_COMPASS_AHEAD_LEFT * ahead + AWMR_COMPASS_LEFT_LEFT * left),
                 AWMR_COMPASS_AHEAD_AHEAD * ahead + AWMR_COMPASS_AHEAD_LEFT * left);
  }
  void lean(float measured_rad, float share) {
    if (!has_heading_) psi_rad = measured_rad;
    has_heading_ = true;
    psi_rad += share * awmr::float_math::wrapped(measured_rad - psi_rad);
  }
  /* The maker's sensitivities: H_adjusted = H ((ASA - 128)/256 + 1). [AK8963 data sheet, 8.3.11] */
  void read_sensitivity() {
    uint8_t bytes[3];
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

}  // namespace awmr_board

#endif /* AWMR_BOARD_IMU_H */
