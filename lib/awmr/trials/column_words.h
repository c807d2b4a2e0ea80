/// Recognises quantities (steer, yaw, gyro, left) and units (kmh, degps, rad) in the names of a
/// file's columns, for column_guess.h.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/trials.h"

namespace awmr {

using Words = std::vector<std::string>;

/// Words that name a time.
extern const std::set<std::string> kClockWords;

/// Splits a name into lower-case words: at characters other than letters and digits, and before a
/// capital that follows a lower-case letter. `IMU.GyrZ` gives imu, gyr, z.
Words words_of(std::string_view name);

/// True if at least one of the words is in `any`.
bool has_any(const Words& words, const std::set<std::string>& any);

enum class Dimension { kForce, kAngle, kAngularRate, kSpeed, kLength, kGeographic, kTime, kCount };

/// Checks whether a file's column whose name has these words may be awmr's `column` in a trial of
/// this kind. Returns its dimension, or empty if it may not.
std::optional<Dimension> dimension_as(TrialKind kind, const std::string& column,
                                      const Words& words);

/// Name of a column with the speed of a left or right wheel.
struct WheelSpeedName {
  bool is_left = false;
  Words rest;  ///< words without the side; equal for the left and the right wheel of a pair
};
/// Returns the side in a name such as vl, left_speed_mps or wheel_vel_r. Empty if the words are not
/// those of a measured speed of one side.
std::optional<WheelSpeedName> wheel_speed_in(const Words& words);

/// Unit in the name of a column.
struct NamedUnit {
  /// Words of the unit, with a space between two: "kmh", "m s" for m/s.
  std::string_view spelling;
  /// Factor by which a value in the file is multiplied to obtain awmr's unit.
  double factor;
};
/// Returns the unit of this dimension that the last word or the last two words name (`m/s` has the
/// words m, s). Empty if they name none. Precondition: `words` is not empty.
std::optional<NamedUnit> unit_in(const Words& words, Dimension dimension);

}  // namespace awmr
