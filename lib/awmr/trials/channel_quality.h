/// What is wrong with one channel of a log, judged by its readings alone: a sensor slower than the
/// log, a coarse one, readings that jump away and back, one that is stuck, one that ends at its
/// range.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace awmr {

/// How a sensor comes to repeat its values.
enum class Repeats {
  kNone,    ///< most rows bring a new value
  kSlow,    ///< slower than the log: its values change at its own rate, and are held in between
  kCoarse,  ///< on a grid: a value changes when the signal crosses to the next step
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
  std::vector<RowSpan> stuck;       ///< one value while the vehicle was told to do other things
  std::size_t saturated = 0;        ///< rows that read the end of the sensor's range
  double saturated_at = 0.0;
};

/// `activity` by row: what the vehicle is told to do, any scale (a signal that is stuck while this
/// changes is stuck; one that rests while this rests is not). Times rise.
///
/// Slow against coarse: a slow sensor leaves at least two rows between changes and jumps by many of
/// its smallest differences; a coarse one changes in neighbouring rows too, mostly by one step. A
/// slow sensor's readings count once; of a coarse one every row counts, since where it does not
/// change the signal did not cross either. Spikes, stuck and saturated rows do not count.
ChannelQuality channel_quality(std::span<const double> t_s, std::span<const double> value,
                               std::span<const double> activity);

}  // namespace awmr
