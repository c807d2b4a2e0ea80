/* GPS: $--RMC sentences on the board's port, 5 Hz or more (an Uno's port is slow: RMC alone). */
#ifndef AWMR_BOARD_GPS_H
#define AWMR_BOARD_GPS_H

#include <stddef.h>

#include "../awmr/control/crc.h"
#include "../awmr/control/gps_check.h"
#include "steps.h"

namespace awmr_board {

/* Where x and y count from, in RAM that a reset leaves alone. After it was switched on RAM holds
   anything, and the check sum fails. */
struct Origin {
  int32_t lat_e7; /* 1e-7 deg */
  int32_t lon_e7;
  uint16_t crc;
};
static Origin kept_origin __attribute__((section(".noinit")));

class Gps {
 public:
  float x_m = 0.0f; /* north of the origin, the first fix */
  float y_m = 0.0f; /* west of it */
  float speed_mps = 0.0f; /* without a sign */
  uint32_t time_ms = 0;   /* of the last fix that was believed, valid once has_fix() */

  /* x and y go on from the origin of before a reset, unless the board was switched off. */
  void begin() {
    port_ = &begin_gps_port();
    if ((reset_cause() & kSwitchedOn) != 0 || !is_kept()) forget_origin();
    check_.begin(AWMR_SPEED_MAX_MPS, AWMR_SPEED_TIMEOUT_MS, millis());
  }
  bool has_fix() const { return has_fix_; }
  bool has_origin() const { return is_kept(); }
  void forget_origin() { kept_origin.crc = static_cast<uint16_t>(~crc_of_origin()); }

  /* Why fixes are not believed; awmr::kSensorGood: they are. */
  awmr::SensorFault fault() const { return check_.fault(millis()); }

  /* In the step, with the speed that is commanded, the heading and whether motors may turn. */
  void read(float u_ref_mps = 0.0f, float psi_rad = 0.0f, bool is_armed = false) {
    const int8_t direction = u_ref_mps > 0.0f ? 1 : u_ref_mps < 0.0f ? -1 : 0;
    const awmr::GpsContext context = {psi_rad, direction, is_armed};
    while (port_->available() > 0) {
      if (line_.take(static_cast<char>(port_->read()))) take_line(context);
    }
  }

 private:
  Stream* port_ = 0;
  awmr::GpsLine line_;
  awmr::GpsCheck check_;
  bool has_fix_ = false;

  static uint16_t crc_of_origin() {
    return awmr::crc16_of(reinterpret_cast<const uint8_t*>(&kept_origin), offsetof(Origin, crc));
  }
  static bool is_kept() { return kept_origin.crc == crc_of_origin(); }

  void take_line(const awmr::GpsContext& context) {
    awmr::GpsFix fix;
    const awmr::GpsSentence kind = awmr::read_rmc(line_.text(), fix);
    const uint32_t now_ms = millis();
    if (kind != awmr::GpsSentence::kFix) return check_.take_unusable(kind, now_ms);
    if (!is_kept()) {
      kept_origin.lat_e7 = fix.lat_e7;
      kept_origin.lon_e7 = fix.lon_e7;
      kept_origin.crc = crc_of_origin();
    }
    const float m_per_e7 = 0.0111319491f; /* of a great circle of 6378137 m */
    const float north_m = static_cast<float>(fix.lat_e7 - kept_origin.lat_e7) * m_per_e7;
    const float west_m = static_cast<float>(kept_origin.lon_e7 - fix.lon_e7) * m_per_e7 *
                         awmr::float_math::cos(static_cast<float>(fix.lat_e7) * 1.74532925e-9f);
    if (!check_.take_fix(fix, north_m, west_m, now_ms, context)) return;
    x_m = north_m;
    y_m = west_m;
    speed_mps = fix.speed_mps;
    time_ms = now_ms;
    has_fix_ = true;
  }
};

}  // namespace awmr_board

#endif /* AWMR_BOARD_GPS_H */
