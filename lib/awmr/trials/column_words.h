/// Words (steer, yaw, gyro, left) and units (kmh, degps, rad) in the names of unknown columns.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/trials/trials.h"

namespace awmr {

using Words = std::vector<std::string>;

/// Splits a name into lower-case words: `IMU.GyrZ` is imu, gyr, z.
Words words_of(std::string_view name);

bool has_any(const Words& words, const std::set<std::string>& any);

enum class Dimension { kForce, kAngle, kAngularRate, kSpeed, kLength, kGeographic, kTime, kCount };

/// Dimension measured by a name's words, if they may name `column` of a trial of this kind.
std::optional<Dimension> dimension_as(TrialKind kind, const std::string& column,
                                      const Words& words);

/// Unit at the end of a name, in its last word or its last two (`m/s` is m, s).
struct NamedUnit {
  std::string_view spelling;
  double factor;  ///< to the unit of awmr's columns
};
std::optional<NamedUnit> unit_in(const Words& words, Dimension dimension);

}  // namespace awmr
