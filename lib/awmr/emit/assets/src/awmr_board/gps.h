/* GPS: reads $--RMC sentences from the board's port. Configure the receiver for 5 Hz or more; for
   an Uno, whose port is slow, switch all other sentences off. */
#ifndef AWMR_BOARD_GPS_H
#define AWMR_BOARD_GPS_H

#include <stddef.h>

#include "../awmr/control/crc.h"
#include "../awmr/emit/board/gps_receiver.h"
#include "../awmr/model/quick_sin.h"
#include "steps.h"

namespace awmr_board {

/* Origin of x and y, in RAM that a reset does not clear. After power-on, RAM is random: the wrong
   check sum then shows that there is no origin. */
struct Origin {
  int32_t lat_e7; /* 1e-7 deg */
  int32_t lon_e7;
  uint16_t crc;
};
static Origin kept_origin __attribute__((section(".noinit")));

struct GpsLimits {
  static constexpr float speed_max_mps = AWMR_SPEED_MAX_MPS;
  static constexpr float on_course_rad = AWMR_ON_COURSE_RAD;
  static constexpr float off_course_mrad = AWMR_OFF_COURSE_MRAD;
  static constexpr uint32_t timeout_ms = AWMR_SPEED_TIMEOUT_MS;
  /* True if the work on a fix is spread over several steps, as for short sample times. */
  static constexpr bool spreads_work = AWMR_SPREADS_FIXES;
};

/* Members of the base class: x_m, y_m, m north and west of the origin (the first fix); speed_mps,
   without a sign; time_ms of the last accepted fix. All are valid once has_fix() is true. */
class Gps : public awmr::GpsReceiver<GpsLimits> {
 public:
  /* Opens the port. Forgets the origin of x and y after power-on; keeps it after other resets. */
  void begin() {
    port_ = &begin_gps_port();
    if ((reset_cause() & kSwitchedOn) != 0 || !is_kept()) forget_origin();
    projection_.set_latitude();
    awmr::GpsReceiver<GpsLimits>::begin(millis());
  }
  bool has_origin() const { return is_kept(); }
  void forget_origin() { kept_origin.crc = static_cast<uint16_t>(~crc_of_origin()); }

  /* Reason why fixes are rejected; awmr::kSensorGood: they are accepted. */
  awmr::SensorFault fault() const { return awmr::GpsReceiver<GpsLimits>::fault(millis()); }

  /* Call in receive(): reads the characters that have arrived. */
  void receive() { awmr::GpsReceiver<GpsLimits>::receive(*port_, millis()); }

  /* Call in the step, with the commanded speed, the measured and the commanded heading, and whether
     the vehicle is armed. */
  void step(float u_ref_mps, float psi_rad, float psi_ref_rad, bool is_armed) {
    const int8_t direction = u_ref_mps > 0.0f ? 1 : u_ref_mps < 0.0f ? -1 : 0;
    const awmr::GpsContext context = {psi_rad, psi_ref_rad, direction, is_armed};
    awmr::GpsReceiver<GpsLimits>::step(projection_, context);
  }

 private:
  /* Converts latitude and longitude to m north and west of the origin, in the tangent plane at the
     origin. The first fix becomes the origin. */
  struct Projection {
    float west_m_per_e7 = 0.0f; /* m per 1e-7 deg of longitude, at the origin's latitude */

    void set_latitude() {
      const float latitude_rad = static_cast<float>(kept_origin.lat_e7) * kRadPerE7;
      west_m_per_e7 = kMetresPerE7 * awmr::math::quick_cos(latitude_rad); /* within 1e-4 */
    }
    awmr::GpsPlace operator()(const awmr::GpsFix& fix) {
      if (!is_kept()) {
        kept_origin.lat_e7 = fix.lat_e7;
        kept_origin.lon_e7 = fix.lon_e7;
        kept_origin.crc = crc_of_origin();
        set_latitude();
      }
      return {static_cast<float>(fix.lat_e7 - kept_origin.lat_e7) * kMetresPerE7,
              static_cast<float>(kept_origin.lon_e7 - fix.lon_e7) * west_m_per_e7};
    }
  };
  /* m per 1e-7 deg on a circle of radius 6378137 m */
  static constexpr float kMetresPerE7 = 0.0111319491f;
  static constexpr float kRadPerE7 = 1.74532925e-9f;
  Stream* port_ = 0;
  Projection projection_;

  static uint16_t crc_of_origin() {
    return awmr::crc16_of(reinterpret_cast<const uint8_t*>(&kept_origin), offsetof(Origin, crc));
  }
  static bool is_kept() { return kept_origin.crc == crc_of_origin(); }
};

}  // namespace awmr_board

#endif /* AWMR_BOARD_GPS_H */
