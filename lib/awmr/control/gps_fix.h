/// Position fix of a GPS receiver, and its conversion from the numbers of an RMC sentence (NMEA
/// 0183).
#pragma once

#include <stdint.h>

namespace awmr {

struct GpsFix {
  uint32_t utc_ms;  ///< time of day, ms since midnight UTC
  int32_t lat_e7;   ///< 1e-7 deg, north positive
  int32_t lon_e7;   ///< 1e-7 deg, east positive
  float speed_mps;  ///< speed over ground, >= 0, without a sign
};

enum class GpsSentence : uint8_t {
  kOther,    ///< complete, but not RMC
  kDamaged,  ///< check sum missing or wrong, a field empty or malformed
  /// complete, but the receiver has no fix, or a fix that was not measured (simulated or entered by
  /// hand)
  kNoFix,
  kFix  ///< complete, with a usable fix
};

/// A GPS speed below this, m/s, can be the noise of a receiver at rest.
constexpr float kStandstill_mps = 0.3F;
/// Seconds and milliseconds of a day.
constexpr uint32_t kDay_s = 86400;
constexpr uint32_t kDay_ms = 1000 * kDay_s;
/// Units of GpsFix::lat_e7 in a degree.
constexpr uint32_t kDegree_e7 = 10000000;

/// A number in a GPS sentence. `whole` has the digits before the decimal point, `part` the decimal
/// places: with three places, ".5" gives 500. In times and angles, `whole` counts in the smallest
/// unit: the digits 1234 for 12 deg 34 min give whole = 12 * 60 + 34.
struct RmcNumber {
  uint32_t whole;
  uint32_t part;
};

/// Numbers of one RMC sentence, not yet converted to the units of GpsFix.
struct RmcNumbers {
  RmcNumber utc;    ///< in s since midnight, and ms
  RmcNumber lat;    ///< latitude: `whole` in minutes of arc, `part` in 1e-7 minutes
  RmcNumber lon;    ///< longitude: `whole` in minutes of arc, `part` in 1e-7 minutes
  RmcNumber knots;  ///< in knots, and 1e-3 knots
  bool is_south;
  bool is_west;
};

namespace detail {

/// Converts minutes of arc to 1e-7 deg:
///   1e7 (whole + 1e-7 part)/60
/// Whole degrees and the rest are converted separately, so that all products fit into 32 bits.
inline int32_t degrees_e7(const RmcNumber& minutes, bool is_negative) {
  const uint16_t whole = static_cast<uint16_t>(minutes.whole);
  const uint16_t degrees = static_cast<uint16_t>(whole / 60U);
  const uint32_t rest = static_cast<uint16_t>(whole - degrees * 60U);
  const int32_t size =
      static_cast<int32_t>(degrees * kDegree_e7 + (rest * kDegree_e7 + minutes.part) / 60U);
  return is_negative ? -size : size;
}

}  // namespace detail

/// Converts the numbers of a sentence to a fix. Precondition: RmcReader::kind() is kFix.
inline GpsFix to_fix(const RmcNumbers& numbers) {
  return {numbers.utc.whole * 1000U + numbers.utc.part,
          detail::degrees_e7(numbers.lat, numbers.is_south),
          detail::degrees_e7(numbers.lon, numbers.is_west),
          static_cast<float>(numbers.knots.whole * 1000U + numbers.knots.part) * 0.514444444e-3F};
}

}  // namespace awmr
