/// Reader for one number of a GPS sentence. Freestanding C++14.
#pragma once

#include "awmr/control/gps_fix.h"

namespace awmr {

/// Reads a number digit by digit.
class RmcNumberReader {
 protected:
  RmcNumber* number_ = 0;    // number into which the field is read; 0: the field is not a number
  uint32_t value_ = 0;       // value of the field's digits since its start or its point
  uint8_t digits_left_ = 0;  // digits still expected before the point
  uint8_t places_left_ = 0;  // digits still kept behind the point
  uint8_t sixties_ = 0;      // bit 0: the next digit is the first of two that are below 60, such as
                             // minutes; bit 1: the same for the digit after it; and so on
  bool has_point_ = false;
  bool is_malformed_ = false;

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
  /// value = 10 value + digit, or 6 value + digit if `is_sixties`. By shifts, because a product
  /// takes an AVR 50 cycles.
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
  /// Stores the number, with zeros for the decimal places that the field does not have.
  void end_number() {
    if (!has_point_) end_whole();
    for (; places_left_ > 0; --places_left_) append(0, false);
    number_->part = value_;
  }
};

}  // namespace awmr
