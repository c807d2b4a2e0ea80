/// Channels that are the same to the last bit in a whole file while others move: a message's unused field, a
/// set-point in place of a measurement, a dead sensor. Private to this folder.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// The values of a column of a log, in its own unit; nothing where there is none.
using ColumnValues = std::function<std::optional<std::span<const double>>(std::string_view column)>;

struct ConstantChannel {
  LogChannel channel;
  double value = 0.0;  ///< in the column's unit
};

/// Of speed, lateral speed, yaw rate and heading those that are constant, where some other channel shows
/// motion: a speed beyond 0.05 m/s, a yaw rate beyond 0.1 rad/s, a heading that changes by 5 deg, a position
/// that changes by 0.2 m. A file of a vehicle at rest has none.
std::vector<ConstantChannel> constant_channels(const ColumnValues& values);

}  // namespace awmr
