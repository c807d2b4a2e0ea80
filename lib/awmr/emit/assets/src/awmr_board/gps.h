/* GPS: $--RMC sentences on the board's port, 5 Hz or more (an Uno's port is slow: RMC alone). */
#ifndef AWMR_BOARD_GPS_H
#define AWMR_BOARD_GPS_H

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "../awmr/control/crc.h"
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
  float speed_mps = 0.0f;
  uint32_t time_ms = 0; /* of the last good fix; 0: none yet */

  /* x and y go on from the origin of before a reset, unless the board was switched off. */
  void begin() {
    port_ = &begin_gps_port();
    if ((reset_cause() & kSwitchedOn) != 0 || !is_kept()) forget_origin();
  }
  bool has_origin() const { return is_kept(); }
  void forget_origin() { kept_origin.crc = static_cast<uint16_t>(~crc_of_origin()); }

  void read() {
    while (port_->available() > 0) {
      const char c = static_cast<char>(port_->read());
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
  Stream* port_ = 0;
  char line_[96];
  uint8_t length_ = 0;

  static uint16_t crc_of_origin() {
    return awmr::crc16_of(reinterpret_cast<const uint8_t*>(&kept_origin), offsetof(Origin, crc));
  }
  static bool is_kept() { return kept_origin.crc == crc_of_origin(); }

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
    if (!is_kept()) {
      kept_origin.lat_e7 = lat;
      kept_origin.lon_e7 = lon;
      kept_origin.crc = crc_of_origin();
    }
    const float m_per_e7 = 0.0111319491f; /* of a great circle of 6378137 m */
    x_m = static_cast<float>(lat - kept_origin.lat_e7) * m_per_e7;
    y_m = static_cast<float>(kept_origin.lon_e7 - lon) * m_per_e7 *
          cos(static_cast<float>(lat) * 1.74532925e-9f);
    speed_mps = static_cast<float>(atof(fields[6])) * 0.514444444f;
    time_ms = millis();
  }
};

}  // namespace awmr_board

#endif /* AWMR_BOARD_GPS_H */
