/// What the names of unknown columns say: words (steer, yaw, gyro, left) and units (kmh, degps, rad).
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/trials.h"

namespace awmr {

using Words = std::vector<std::string>;

/// A name in its words, lower case: `IMU.GyrZ` is imu, gyr, z.
Words words_of(std::string_view name);

bool has_any(const Words& words, const std::set<std::string>& any);

enum class Dimension { kForce, kAngle, kAngularRate, kSpeed, kLength, kGeographic, kTime, kCount };

/// What a name's words measure, where they may name `column` of a trial of this kind.
std::optional<Dimension> dimension_as(TrialKind kind, const std::string& column,
                                      const Words& words);

/// A unit that a name ends in, by its last word or its last two (`m/s` is m, s).
struct NamedUnit {
  std::string_view spelling;
  double factor;  ///< to the unit that awmr's columns are in
};
std::optional<NamedUnit> unit_in(const Words& words, Dimension dimension);

}  // namespace awmr
