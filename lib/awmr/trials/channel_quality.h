/// Quality checks of one log channel by its readings: sensors slower than the log, coarse
/// resolution, spikes, stuck values, saturation.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace awmr {

/// Reason why a sensor repeats its values.
enum class Repeats {
  kNone,    ///< most rows bring a new value
  kSlow,    ///< slower than the log: values change at the sensor's rate and are held in between
  kCoarse,  ///< on a grid: the value changes when the signal crosses to the next step
};

/// Rows [begin, end).
struct RowSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
};

struct ChannelQuality {
  Repeats repeats = Repeats::kNone;
  std::vector<bool> fresh;          ///< by row: counts as measured
  double quantum = 0.0;             ///< step of a coarse sensor, in the unit of the values
  std::vector<std::size_t> spikes;  ///< rows that jump away and back
  std::vector<RowSpan> stuck;       ///< constant while the command changed
  std::size_t saturated = 0;        ///< rows at the end of the sensor's range
  double saturated_at = 0.0;
};

/// `activity` by row: the command, in any scale. A signal that is constant while this changes is
/// stuck; a signal at rest while this rests is not. Times are ascending.
///
/// A slow sensor changes in at most every second row, by many of its smallest differences. A
/// coarse one also changes in neighbouring rows, mostly by one step. Each reading of a slow sensor
/// counts once. Of a coarse one every row counts, because an unchanged value means that the signal
/// did not cross a step. Spikes, stuck and saturated rows do not count.
ChannelQuality channel_quality(std::span<const double> t_s, std::span<const double> value,
                               std::span<const double> activity);

}  // namespace awmr
