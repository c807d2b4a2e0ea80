/// Measures the zero-rate offset of a gyroscope before the vehicle moves.
#pragma once

#include "awmr/emit/board/sensor_fault.h"

namespace awmr {

/// Measures the zero-rate offset of a gyroscope as the mean of 100 readings. The measurement starts
/// again if the vehicle was not at rest. Signs of motion: the spread or the mean of the readings,
/// or the change of the compass heading, is too large.
class GyroCalibration {
 public:
  /// Processes the gyroscope's raw reading `word` of one sample; a count of 1 is `rate_per_word`
  /// rad/s. `heading_rad` is the compass heading, valid if `has_heading`.
  void take(int16_t word, float rate_per_word, bool has_heading, float heading_rad) {
    if (is_done_) return;
    if (count_ == 0) start(word);
    if (word < least_) least_ = word;
    if (word > most_) most_ = word;
    sum_ += word;
    ++count_;
    if (has_heading) take_heading(heading_rad);
    if (count_ < kSamples) return;
    bias_radps_ = static_cast<float>(sum_) * rate_per_word / static_cast<float>(kSamples);
    bias_word_ = static_cast<int16_t>(sum_ / kSamples);
    const float spread_radps =
        static_cast<float>(static_cast<int32_t>(most_) - least_) * rate_per_word;
    count_ = 0;
    is_done_ = spread_radps < kSpreadMax_radps && detail::size_of(bias_radps_) < kBiasMax_radps &&
               detail::size_of(turned_rad_) < kTurnMax_rad;
  }
  bool is_done() const { return is_done_; }
  float bias_radps() const { return bias_radps_; }
  int16_t bias_word() const { return bias_word_; }

 private:
  static constexpr uint8_t kSamples = 100;
  /// Maximum difference between two readings of a vehicle at rest, rad/s. It is six times the
  /// peak-to-peak noise of an MPU9250 with its 41 Hz filter.
  static constexpr float kSpreadMax_radps = 0.05F;
  /// Maximum zero-rate offset, rad/s (5.2 deg/s). The data sheet specifies at most 5 deg/s, so a
  /// larger mean is a rotation of the vehicle.
  static constexpr float kBiasMax_radps = 0.09F;
  /// Maximum change of the compass heading during the measurement, rad (3.4 deg, of which 1.4 deg
  /// can be noise).
  static constexpr float kTurnMax_rad = 0.06F;

  int32_t sum_ = 0;
  int16_t least_ = 0;
  int16_t most_ = 0;
  uint8_t count_ = 0;
  bool is_done_ = false;
  float bias_radps_ = 0.0F;
  int16_t bias_word_ = 0;
  float first_rad_ = 0.0F;
  float turned_rad_ = 0.0F;  // change of the compass heading since the first reading
  bool has_first_ = false;

  void start(int16_t word) {
    sum_ = 0;
    least_ = most_ = word;
    turned_rad_ = 0.0F;
    has_first_ = false;
  }
  void take_heading(float heading_rad) {
    if (!has_first_) first_rad_ = heading_rad;
    has_first_ = true;
    turned_rad_ = float_math::wrapped(heading_rad - first_rad_);
  }
};

}  // namespace awmr
