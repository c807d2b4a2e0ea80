/// Finds channels with a single value in the whole file while other channels move. Causes: an
/// unused message field, a set-point logged as a measurement, or a dead sensor. Private to trials/.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Function that returns the values of a log column in the column's unit; empty if the file lacks
/// the column.
using ColumnValues = std::function<std::optional<std::span<const double>>(std::string_view column)>;

struct ConstantChannel {
  LogChannel channel;
  double value = 0.0;  ///< the constant value, in the column's unit
};

/// Returns which of speed, lateral speed, yaw rate and heading are constant (in 10 rows or more)
/// while another channel shows motion. Motion is a speed or lateral speed of at least 0.05 m/s, a
/// yaw rate of 0.1 rad/s, a heading change of 5 deg or a position change of 0.2 m. Empty for a
/// vehicle at rest.
std::vector<ConstantChannel> constant_channels(const ColumnValues& values);

}  // namespace awmr
