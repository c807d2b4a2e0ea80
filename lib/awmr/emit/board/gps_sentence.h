/// Strict reader for the RMC sentence of a GPS receiver (NMEA 0183), and the conversion of its
/// numbers to a position fix. A sentence with an empty or malformed field, or with a missing or
/// wrong check sum, is unusable. The reader processes each character when it arrives, with integers
/// only, so that the computing time is spread over several control steps.
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

namespace detail {

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Value of a hexadecimal digit, or 16.
inline uint8_t hex_value(char c) {
  if (is_digit(c)) return static_cast<uint8_t>(c - '0');
  if (c >= 'A' && c <= 'F') return static_cast<uint8_t>(c - 'A' + 10);
  if (c >= 'a' && c <= 'f') return static_cast<uint8_t>(c - 'a' + 10);
  return 16;
}

}  // namespace detail

/// Reads sentences of this form from the characters of a port, and ignores everything else:
///   $xxRMC,time,A,lat,N,lon,E,knots,course,date,variation,E,mode*hh
/// xx are two characters for the satellite system, as in $GPRMC and $GNRMC; hh is the check sum.
class RmcReader {
 public:
  /// Processes a character. Returns true if it ended a sentence. kind() and numbers() are then
  /// valid until the next sentence starts (character $). A sentence that is too long is dropped.
  bool take(char c) {
    const uint8_t digit = static_cast<uint8_t>(c - '0');
    if (c == '$') {
      begin_sentence();
    } else if (!is_open_ || ++length_ > kLengthMax) {
      is_open_ = false;
    } else if (number_ != 0 && digit <= 9) {
      // Most characters are digits of a number field. They need none of the tests below.
      add_to_sum(c);
      take_digit(digit);
    } else if (c == '\n' || c == '\r') {
      is_open_ = false;
      return true;
    } else if (sum_place_ != kSummed) {
      take_sum(c);
    } else if (c == '*') {
      end_field();
      sum_place_ = kHighDigit;
    } else {
      add_to_sum(c);
      if (is_rmc_) take_in_field(c);
    }
    return false;
  }

  GpsSentence kind() const {
    if (sum_place_ != kComplete || sum_ != 0) return GpsSentence::kDamaged;
    if (!is_rmc_ || field_ == kTalker) return GpsSentence::kOther;
    if (field_ < kKnots) return GpsSentence::kDamaged;
    if (status_ == 'V') return GpsSentence::kNoFix;
    // Since NMEA 2.3, the sentence has the mode of the fix: N no fix, E dead reckoning, M entered
    // by hand, S simulated. In these modes, the position is not measured.
    if (status_ == 'A' && (mode_ == 'N' || mode_ == 'E' || mode_ == 'M' || mode_ == 'S')) {
      return GpsSentence::kNoFix;
    }
    return status_ != 'A' || is_malformed_ ? GpsSentence::kDamaged : GpsSentence::kFix;
  }
  const RmcNumbers& numbers() const { return numbers_; }

 private:
  /// Maximum length of a sentence, counted from the $ to the first character of the line end.
  static constexpr uint8_t kLengthMax = 96;

  enum Field : uint8_t {
    kTalker,
    kUtc,
    kStatus,
    kLat,
    kNorth,
    kLon,
    kEast,
    kKnots,
    kMode = 12,
    kBeyond
  };
  /// Role of the next character: covered by the check sum, digit of the check sum, or after it.
  enum SumPlace : uint8_t { kSummed, kHighDigit, kLowDigit, kComplete, kTooMuch };

  RmcNumbers numbers_ = {};
  uint8_t field_ = kTalker;
  uint8_t size_ = 0;  // characters of this field
  uint8_t length_ = 0;
  uint8_t sum_ = 0;
  SumPlace sum_place_ = kSummed;
  char status_ = 0;
  char mode_ = 0;
  bool is_open_ = false;
  bool is_rmc_ = false;
  // The number of the current field. Destination; 0: the field is not a number.
  RmcNumber* number_ = 0;
  uint32_t value_ = 0;       // value of the digits read so far, before or after the point
  uint8_t digits_left_ = 0;  // digits still expected before the decimal point
  uint8_t places_left_ = 0;  // decimal places still to be read; later ones are ignored
  // Mask of the digits that are tens of minutes or seconds, which must be below 6. Bit 0: the next
  // digit, bit 1: the digit after it, and so on.
  uint8_t sixties_ = 0;
  bool has_point_ = false;
  bool is_malformed_ = false;

  void begin_sentence() {
    length_ = 1;
    sum_ = 0;
    sum_place_ = kSummed;
    field_ = kTalker;
    size_ = 0;
    number_ = 0;
    status_ = mode_ = 0;
    is_open_ = is_rmc_ = true;
    is_malformed_ = false;
  }

  void add_to_sum(char c) { sum_ = static_cast<uint8_t>(sum_ ^ static_cast<uint8_t>(c)); }

  void take_sum(char c) {
    const uint8_t digit = detail::hex_value(c);
    if (digit > 15 || sum_place_ > kLowDigit) {
      sum_place_ = kTooMuch;
    } else if (sum_place_ == kHighDigit) {
      sum_ = static_cast<uint8_t>(sum_ ^ digit << 4U);
      sum_place_ = kLowDigit;
    } else {
      sum_ = static_cast<uint8_t>(sum_ ^ digit);
      sum_place_ = kComplete;
    }
  }

  void take_in_field(char c) {
    if (c == ',') {
      end_field();
      begin_field();
    } else if (number_ == 0) {
      take_letter(c);
      if (size_ < 255) ++size_;
    } else if (c == '.' && !has_point_) {
      end_whole();
    } else {
      is_malformed_ = true;
    }
  }

  void take_letter(char c) {
    switch (field_) {
      case kTalker:
        if (size_ > 4 || (size_ > 1 && c != "RMC"[size_ - 2])) is_rmc_ = false;
        break;
      case kStatus:
        if (size_ == 0 || status_ != 'V') status_ = size_ == 0 ? c : 'X';
        break;
      case kNorth:
        numbers_.is_south = c == 'S';
        if (c != 'N' && c != 'S') is_malformed_ = true;
        break;
      case kEast:
        numbers_.is_west = c == 'W';
        if (c != 'E' && c != 'W') is_malformed_ = true;
        break;
      case kMode:
        if (size_ == 0) mode_ = c;
        break;
      default:
        break;
    }
  }

  void begin_field() {
    size_ = 0;
    if (field_ < kBeyond) ++field_;
    // Arguments of begin_number() after the number: digits before the point (for the speed, a
    // maximum), decimal places used, and a mask of the digits that must be below 6, because they
    // are tens of minutes or seconds. Formats: time hhmmss[.s*] (a leap second is refused),
    // latitude ddmm.m*, longitude dddmm.m*.
    if (field_ == kUtc) begin_number(numbers_.utc, 6, 3, 0x14);
    if (field_ == kLat) begin_number(numbers_.lat, 4, 7, 0x04);
    if (field_ == kLon) begin_number(numbers_.lon, 5, 7, 0x08);
    if (field_ == kKnots) begin_number(numbers_.knots, 5, 3, 0x00);
  }
  void end_field() {
    if (field_ == kTalker && size_ != 5) is_rmc_ = false;
    if ((field_ == kNorth || field_ == kEast) && size_ != 1) is_malformed_ = true;
    if (number_ == 0) return;
    const bool has_point = has_point_;
    end_number();
    if (field_ == kKnots ? digits_left_ > 4 : digits_left_ > 0) is_malformed_ = true;
    if (field_ == kUtc && number_->whole >= kDay_s) is_malformed_ = true;
    if (field_ == kLat || field_ == kLon) {
      const uint16_t most = static_cast<uint16_t>((field_ == kLat ? 90U : 180U) * 60U);
      if (!has_point || number_->whole > most || (number_->whole == most && value_ != 0)) {
        is_malformed_ = true;
      }
    }
    number_ = 0;
  }

  void begin_number(RmcNumber& number, uint8_t digits, uint8_t places, uint8_t sixties) {
    number_ = &number;
    value_ = 0;
    digits_left_ = digits;
    places_left_ = places;
    sixties_ = sixties;
    has_point_ = false;
  }

  void take_digit(uint8_t digit) {
    bool is_sixties = false;
    if (has_point_) {
      if (places_left_ == 0) return;
      --places_left_;
    } else {
      if (digits_left_ == 0) is_malformed_ = true;
      --digits_left_;
      is_sixties = (sixties_ & 1U) != 0;
      sixties_ = static_cast<uint8_t>(sixties_ >> 1U);
      if (is_sixties && digit > 5) is_malformed_ = true;
    }
    append(digit, is_sixties);
  }
  /// Appends a digit: value = 10 value + digit. For tens of minutes and seconds (`is_sixties`):
  /// value = 6 value + digit. The code uses shifts, because a product takes 50 cycles on an AVR.
  void append(uint8_t digit, bool is_sixties) {
    const uint32_t twice = value_ << 1U;
    uint32_t rest = twice << 1U;
    if (!is_sixties) rest <<= 1U;
    value_ = rest + twice + digit;
  }
  void end_whole() {
    number_->whole = value_;
    value_ = 0;
    has_point_ = true;
  }
  /// Stores the number. Decimal places that the field does not have are 0.
  void end_number() {
    if (!has_point_) end_whole();
    for (; places_left_ > 0; --places_left_) append(0, false);
    number_->part = value_;
  }
};

}  // namespace awmr
