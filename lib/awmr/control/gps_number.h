/// Reader for one number of a GPS sentence, digit by digit.
#pragma once

#include "awmr/control/gps_fix.h"

namespace awmr {

/// Reads a number digit by digit.
class RmcNumberReader {
 protected:
  // Destination of the number. 0: the current field is not a number.
  RmcNumber* number_ = 0;
  uint32_t value_ = 0;       // value of the digits read so far, before or after the point
  uint8_t digits_left_ = 0;  // digits still expected before the decimal point
  uint8_t places_left_ = 0;  // decimal places still to be read; later ones are ignored
  // Mask of the digits that are tens of minutes or seconds, which must be below 6. Bit 0: the next
  // digit, bit 1: the digit after it, and so on.
  uint8_t sixties_ = 0;
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
