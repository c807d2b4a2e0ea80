/// Quality checks of the readings of one log channel: sensor slower than the log, coarse
/// resolution, spikes, stuck values, saturation.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Reason why a sensor repeats its values.
enum class Repeats {
  kNone,    ///< neither slow nor coarse: repeated values are measurements, too
  kSlow,    ///< sensor slower than the log: values are repeated until the next reading
  kCoarse,  ///< coarse resolution: the value changes only when the signal reaches the next step
};

struct ChannelQuality {
  Repeats repeats = Repeats::kNone;
  std::vector<bool> fresh;             ///< for each row: true if the value is a measurement
  double quantum = 0.0;                ///< resolution, in the unit of the values; 0: not detected
  std::vector<std::size_t> spikes;     ///< rows with a spike: the value jumps away and back
  std::vector<RowSpan> stuck;          ///< rows with one repeated value while the command changed
  std::vector<RowSpan> stuck_at_zero;  ///< rows of zeros while the command drives the vehicle
  /// Number of rows in which the value is at an end of the sensor's range.
  std::size_t saturated = 0;
  /// Value at this end of the range, in the unit of the values.
  double saturated_at = 0.0;
};

/// Determines why `value` contains repeated readings: sets only `repeats`, `fresh` and `quantum`,
/// by the rules of channel_quality(). If the value changes fewer than 8 times, every row counts as
/// a measurement.
ChannelQuality find_repeats(std::span<const double> value);

/// Returns the resolution of readings that were written only when they had changed; 0 for other
/// readings. Criterion: no reading equals the reading before it, and most changes are one step of
/// the resolution. (Readings at regular times that change so little would sometimes stay the same.)
/// Needs at least 30 changes. Accepts two zeros in a row, because a logger may write -0 after 0 as
/// a changed value.
double resolution_of_changes(std::span<const double> readings);

/// The largest magnitude of the values; 0 if there are none.
double largest_size(std::span<const double> values);

/// Finds the runs of equal values that last 1 s or more, and at least eight times as many rows as
/// the 90 % quantile of all runs of equal values.
std::vector<RowSpan> long_constant_runs(std::span<const double> t_s, std::span<const double> value);

/// Checks the readings `value` at the ascending times `t_s`. `activity`: the command that moves the
/// signal, by row, in any unit. A signal that is constant while `activity` changes is stuck.
///
/// The value of a slow sensor changes only when the sensor has a new reading. Its rate is at most
/// half the rate of the log (changes at least two rows apart), or between half and the whole rate
/// (changes one or two rows apart). Only rows with a new reading are measurements. The value of a
/// coarse sensor can change in any row, mostly by one step of the resolution. Each row of a coarse
/// sensor is a measurement, because an unchanged value means that the signal did not reach the next
/// step. Rows with spikes, stuck values (except the first row) or saturated values are not
/// measurements.
ChannelQuality channel_quality(std::span<const double> t_s, std::span<const double> value,
                               std::span<const double> activity);

/// Finds zeros of a stuck sensor of a speed or a yaw rate: `stuck_at_zero`, no measurements. Zeros
/// of a vehicle at rest are similar, so a run of zeros is stuck only if
///   - it is long, compared with the other spans of equal values, and not at the start of the log;
///   - the readings jump to 0 and from 0, each time by far more than readings usually change. One
///     jump is sufficient if the log has no other long run of zeros;
///   - the sensor reads values between 0 and half of this jump at other times;
///   - the commands in the run are as large as those that move the vehicle at other times.
/// Arguments: see channel_quality(), which must have computed `quality`.
void find_stuck_at_zero(std::span<const double> t_s, std::span<const double> value,
                        std::span<const double> activity, ChannelQuality& quality);

/// Marks most readings of an encoder at rest as no measurements: a speed or yaw rate from counts is
/// then exactly 0 in each row. As long as the count does not change, its rounding error does not
/// change either, so these readings are not independent. A fit with differenced noise would take
/// the position at which the vehicle stopped as measured many times. Of at least ten zeros in
/// a row, these stay measurements: the first three, one per second, and those at the end, in which
/// the vehicle may move again by less than a step. The end begins with the last change of the
/// command `activity`, but at most 0.3 s before the next other value. Changes nothing unless all
/// values are multiples of a resolution of at least 1 % of the largest value.
void leave_out_rest(std::span<const double> t_s, std::span<const double> value,
                    std::span<const double> activity, ChannelQuality& quality);

}  // namespace awmr
