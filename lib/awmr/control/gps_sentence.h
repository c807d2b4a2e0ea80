/// RMC sentence of a GPS (NMEA 0183), read strictly: a field that is empty or malformed, or a check
/// sum that is missing or wrong, makes the whole sentence unusable. Freestanding C++14.
#pragma once

#include <stdint.h>

namespace awmr {

/// One position fix.
struct GpsFix {
  uint32_t utc_ms;  ///< time of day, ms since midnight UTC
  int32_t lat_e7;   ///< 1e-7 deg, north positive
  int32_t lon_e7;   ///< 1e-7 deg, east positive
  float speed_mps;  ///< over ground, >= 0, without a sign
};

enum class GpsSentence : uint8_t {
  kOther,    ///< whole, but not RMC
  kDamaged,  ///< check sum missing or wrong, a field empty or malformed
  kNoFix,    ///< whole, but the receiver has no fix or only estimates it
  kFix
};

/// Speeds below it, m/s, are noise of a receiver at rest.
constexpr float kStandstill_mps = 0.3F;
/// Milliseconds of a day.
constexpr uint32_t kDay_ms = 86400000;
/// Units of GpsFix::lat_e7 in a degree.
constexpr uint32_t kDegree_e7 = 10000000;

namespace detail {

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Value of a hexadecimal digit, or 16.
inline uint8_t hex_value(char c) {
  if (is_digit(c)) return static_cast<uint8_t>(c - '0');
  if (c >= 'A' && c <= 'F') return static_cast<uint8_t>(c - 'A' + 10);
  if (c >= 'a' && c <= 'f') return static_cast<uint8_t>(c - 'a' + 10);
  return 16;
}

/// Reads `count` digits at `text` into `value`. False: there are fewer.
inline bool read_digits(const char*& text, uint8_t count, uint32_t& value) {
  value = 0;
  for (; count > 0; --count, ++text) {
    if (!is_digit(*text)) return false;
    value = value * 10U + static_cast<uint32_t>(*text - '0');
  }
  return true;
}

/// Reads [.d*] up to the end of the field as units of 10^-places. False: something else is there.
inline bool read_fraction(const char*& text, uint8_t places, uint32_t& value) {
  value = 0;
  if (*text == '.') {
    for (++text; is_digit(*text); ++text) {
      if (places == 0) continue;
      value = value * 10U + static_cast<uint32_t>(*text - '0');
      --places;
    }
  }
  for (; places > 0; --places) value *= 10U;
  return *text == ',' || *text == '*';
}

/// The start of the field after this one; 0 at the end of the sentence.
inline const char* next_field(const char* text) {
  while (*text != ',' && *text != '*' && *text != '\0') ++text;
  return *text == ',' ? text + 1 : 0;
}

/// hhmmss[.s*]
inline bool read_utc(const char* text, uint32_t& utc_ms) {
  uint32_t hours = 0;
  uint32_t minutes = 0;
  uint32_t seconds = 0;
  uint32_t part_ms = 0;
  if (!read_digits(text, 2, hours) || !read_digits(text, 2, minutes) ||
      !read_digits(text, 2, seconds) || !read_fraction(text, 3, part_ms)) {
    return false;
  }
  utc_ms = ((hours * 60U + minutes) * 60U + seconds) * 1000U + part_ms;
  return hours < 24 && minutes < 60 && seconds < 61;
}

/// ddmm.m* or dddmm.m*, then the field of the hemisphere: `plus` or `minus`.
inline bool read_degrees(const char* text, uint8_t degree_digits, char plus, char minus,
                         int32_t& degrees_e7) {
  uint32_t degrees = 0;
  uint32_t minutes = 0;
  uint32_t part_e7 = 0;
  if (!read_digits(text, degree_digits, degrees) || !read_digits(text, 2, minutes) ||
      *text != '.' || !read_fraction(text, 7, part_e7)) {
    return false;
  }
  const char* hemisphere = next_field(text);
  if (hemisphere == 0 || (*hemisphere != plus && *hemisphere != minus)) return false;
  if (hemisphere[1] != ',') return false;
  const uint32_t most = degree_digits == 2 ? 90 : 180;
  if (degrees > most || minutes > 59) return false;
  const uint32_t whole = degrees * kDegree_e7 + (minutes * kDegree_e7 + part_e7) / 60U;
  if (whole > most * kDegree_e7) return false;
  degrees_e7 = *hemisphere == plus ? static_cast<int32_t>(whole) : -static_cast<int32_t>(whole);
  return true;
}

/// d*[.d*] knots, at most five digits before the point.
inline bool read_knots(const char* text, float& speed_mps) {
  uint32_t whole = 0;
  uint32_t part = 0;
  uint8_t digits = 0;
  for (; is_digit(*text) && digits < 5; ++text, ++digits) {
    whole = whole * 10U + static_cast<uint32_t>(*text - '0');
  }
  if (digits == 0 || !read_fraction(text, 3, part)) return false;
  speed_mps = static_cast<float>(whole * 1000U + part) * 0.514444444e-3F;
  return true;
}

/// $...*hh: hh is the exclusive or of the characters between. Nothing but a line's end follows.
inline bool has_right_sum(const char* line) {
  if (*line != '$') return false;
  uint8_t sum = 0;
  const char* at = line + 1;
  for (; *at != '*' && *at != '\0'; ++at)
    sum = static_cast<uint8_t>(sum ^ static_cast<uint8_t>(*at));
  if (*at != '*') return false;
  const uint8_t high = hex_value(at[1]);
  if (high > 15) return false;
  const uint8_t low = hex_value(at[2]);
  if (low > 15 || static_cast<uint8_t>(high * 16U + low) != sum) return false;
  return at[3] == '\0' || at[3] == '\r' || at[3] == '\n';
}

}  // namespace detail

/// Reads $xxRMC,time,A,lat,N,lon,E,knots,course,date,variation,E,mode*hh. `fix` is complete for kFix
/// only. `line` ends with 0.
inline GpsSentence read_rmc(const char* line, GpsFix& fix) {
  if (!detail::has_right_sum(line)) return GpsSentence::kDamaged;
  // The talker has two characters: $GPRMC, $GNRMC.
  for (uint8_t i = 1; i < 7; ++i) {
    if (line[i] == '\0') return GpsSentence::kOther;
  }
  if (line[3] != 'R' || line[4] != 'M' || line[5] != 'C' || line[6] != ',') {
    return GpsSentence::kOther;
  }
  const char* fields[12];  // from the time on
  uint8_t count = 0;
  for (const char* at = line + 7; at != 0 && count < 12; at = detail::next_field(at)) {
    fields[count++] = at;
  }
  if (count < 7) return GpsSentence::kDamaged;
  if (*fields[1] == 'V') return GpsSentence::kNoFix;
  if (fields[1][0] != 'A' || fields[1][1] != ',') return GpsSentence::kDamaged;
  // NMEA 2.3 and later: how the fix was made. N none, E by dead reckoning, M by hand, S simulated.
  if (count == 12) {
    const char mode = *fields[11];
    if (mode == 'N' || mode == 'E' || mode == 'M' || mode == 'S') return GpsSentence::kNoFix;
  }
  if (!detail::read_utc(fields[0], fix.utc_ms) ||
      !detail::read_degrees(fields[2], 2, 'N', 'S', fix.lat_e7) ||
      !detail::read_degrees(fields[4], 3, 'E', 'W', fix.lon_e7) ||
      !detail::read_knots(fields[6], fix.speed_mps)) {
    return GpsSentence::kDamaged;
  }
  return GpsSentence::kFix;
}

/// Collects the characters of a port into lines, each from a $ on. A line that is too long is
/// dropped.
class GpsLine {
 public:
  /// True: text() is a line that is complete.
  bool take(char c) {
    if (c == '$') {
      length_ = 0;
      is_open_ = true;
    }
    if (!is_open_) return false;
    if (c == '\n' || c == '\r') {
      is_open_ = false;
      text_[length_] = '\0';
      return length_ > 0;
    }
    if (length_ + 1U >= sizeof text_) {
      is_open_ = false;
      return false;
    }
    text_[length_++] = c;
    return false;
  }
  const char* text() const { return text_; }

 private:
  char text_[96] = {};
  uint8_t length_ = 0;
  bool is_open_ = false;
};

}  // namespace awmr
