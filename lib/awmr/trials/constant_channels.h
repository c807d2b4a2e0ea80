/// Channels with exactly one value in a whole file while others move: an unused message field, a
/// set-point logged as a measurement, a dead sensor. Private to this folder.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Returns the values of a log column in its own unit; empty if there is none.
using ColumnValues = std::function<std::optional<std::span<const double>>(std::string_view column)>;

struct ConstantChannel {
  LogChannel channel;
  double value = 0.0;  ///< in the column's unit
};

/// Returns the constant ones of speed, lateral speed, yaw rate and heading, if another channel
/// contains motion. Motion is a speed beyond 0.05 m/s, a yaw rate beyond 0.1 rad/s, a heading
/// change of 5 deg or a position change of 0.2 m. A file of a vehicle at rest has none.
std::vector<ConstantChannel> constant_channels(const ColumnValues& values);

}  // namespace awmr
