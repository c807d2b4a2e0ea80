#include "awmr/trials/checks/channel_quality.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "awmr/core/statistics/sample_quantile.h"

namespace awmr {
namespace {

/// If more than this fraction of the values repeat the value before, the sensor has a coarse
/// resolution. If fewer do, the steps between values come only from the decimal places in the file.
constexpr double kSomeRepeats = 0.2;

/// Rows at which the value changes, the magnitude of each change, and the number of rows from each
/// change to the next.
struct Changes {
  std::vector<std::size_t> row;
  std::vector<double> step;
  std::vector<double> gap;  ///< one fewer than changes
};

Changes changes_of(std::span<const double> value) {
  Changes changes;
  for (std::size_t i = 1; i < value.size(); ++i) {
    if (value[i] == value[i - 1]) continue;
    if (!changes.row.empty()) changes.gap.push_back(static_cast<double>(i - changes.row.back()));
    changes.row.push_back(i);
    changes.step.push_back(std::abs(value[i] - value[i - 1]));
  }
  return changes;
}

/// Returns the resolution of the sensor. It is the smallest change, if nearly all changes are
/// multiples of this change and most are one or two times as large. Otherwise returns 0.
double quantum_of(const Changes& changes) {
  const double smallest = *std::min_element(changes.step.begin(), changes.step.end());
  std::size_t on_grid = 0;
  std::vector<double> steps;
  for (const double step : changes.step) {
    const double times = step / smallest;
    steps.push_back(times);
    // The tolerance is needed because the file may give the values with few digits.
    if (std::abs(times - std::round(times)) < 0.05 + 1e-6 * times) ++on_grid;
  }
  const bool grid = static_cast<double>(on_grid) > 0.98 * static_cast<double>(steps.size());
  constexpr double kMostlySteps = 2.5;
  return grid && median(steps) < kMostlySteps ? smallest : 0.0;
}

/// True for a coarse sensor without noise: at least 95 % of the changes are one step of the
/// resolution, and fewer than 80 % of the gaps between changes are multiples of one interval. (The
/// changes of a slow sensor are at multiples of its sample interval.)
bool changes_step_by_step(const Changes& changes, double quantum) {
  constexpr double kNearlyAll = 0.95;
  constexpr double kRegular = 0.8;
  // A gap counts as a multiple of the sample interval if it differs by at most this fraction of the
  // interval.
  constexpr double kOffMultiple = 0.15;
  if (!(quantum > 0.0)) return false;
  const auto single =
      std::ranges::count_if(changes.step, [&](double step) { return step < 1.5 * quantum; });
  if (static_cast<double>(single) < kNearlyAll * static_cast<double>(changes.step.size())) {
    return false;
  }
  const double interval = quantile(changes.gap, 0.05);
  const auto multiples = std::ranges::count_if(changes.gap, [&](double gap) {
    return std::abs(gap - interval * std::round(gap / interval)) <= kOffMultiple * interval;
  });
  return static_cast<double>(multiples) < kRegular * static_cast<double>(changes.gap.size());
}

/// Marks the rows in which a slow sensor has a new reading: those in which the value changes. If
/// the value stays the same for several usual intervals between changes (the median, at least two
/// rows), the sensor probably read the same value again, so one row in each of these intervals is
/// marked as well.
std::vector<bool> slow_readings(const Changes& changes, std::size_t rows) {
  std::vector<bool> fresh(rows, false);
  fresh[0] = true;
  const auto usual = static_cast<std::size_t>(std::max(2.0, median(changes.gap)));
  for (std::size_t k = 0; k < changes.row.size(); ++k) {
    const std::size_t end = k + 1 < changes.row.size() ? changes.row[k + 1] : rows;
    for (std::size_t i = changes.row[k]; i + usual / 2 < end || i == changes.row[k]; i += usual) {
      fresh[i] = true;
    }
  }
  return fresh;
}

/// Deviation of each reading from the median of five: the reading and two neighbours on either
/// side. It is large for a jump away and back within two readings, and small for a step. 0 for the
/// first and last two readings.
std::vector<double> off_median(std::span<const double> value) {
  std::vector<double> off(value.size(), 0.0);
  for (std::size_t k = 2; k + 2 < value.size(); ++k) {
    const std::span<const double> five = value.subspan(k - 2, 5);
    off[k] = value[k] - median({five.begin(), five.end()});
  }
  return off;
}

bool all_equal(std::span<const double> values) {
  return std::ranges::all_of(values, [&](double v) { return v == values.front(); });
}

/// Returns the limit of the deviation |off| (off_median()) above which a reading is a spike. It is
/// the largest of these values:
///   - 7 standard deviations of the noise, times 1 + 5/sqrt(n), because n readings give the
///     standard deviation only approximately. The standard deviation is the 75 % quantile of |off|,
///     divided by 1.04. The quantile leaves out readings in the middle of five equal readings (an
///     encoder at rest);
///   - three times the 80 % quantile of the change between readings, because motion can change
///     sharply;
///   - a tenth of the range between the 2 % and the 98 % quantile of the values;
///   - three times the resolution.
double spike_limit(std::span<const double> value, std::span<const double> off, double quantum) {
  constexpr double kQuantileOverStd = 1.04;
  constexpr double kStandardDeviations = 7.0;
  constexpr double kChanges = 3.0;
  std::vector<double> size;
  for (std::size_t k = 2; k + 2 < value.size(); ++k) {
    if (!all_equal(value.subspan(k - 2, 5))) size.push_back(std::abs(off[k]));
  }
  if (size.empty()) return 0.0;
  std::vector<double> change;
  for (std::size_t k = 1; k < value.size(); ++k) {
    change.push_back(std::abs(value[k] - value[k - 1]));
  }
  const std::vector<double> all(value.begin(), value.end());
  const double noise = quantile(size, 0.75) / kQuantileOverStd;
  const double margin = 1.0 + 5.0 / std::sqrt(static_cast<double>(size.size()));
  const double range = quantile(all, 0.98) - quantile(all, 0.02);
  return std::max({kStandardDeviations * margin * noise, kChanges * quantile(change, 0.8),
                   0.1 * range, 3.0 * quantum});
}

/// True if reading `k` is near the straight line through two readings on one side (-1: before, 1:
/// after). Reading `k` is then a sharp change of motion, not a spike. The first of these two
/// readings is the nearest reading that is not itself a possible spike; the second is the next
/// reading beyond.
bool is_reached_from(std::span<const double> value, std::span<const double> off, double limit,
                     std::size_t k, std::ptrdiff_t side) {
  const auto rows = static_cast<std::ptrdiff_t>(value.size());
  const auto at_row = static_cast<std::ptrdiff_t>(k);
  std::ptrdiff_t near = at_row + side;
  while (near >= 0 && near < rows && std::abs(off[static_cast<std::size_t>(near)]) > limit) {
    near += side;
  }
  const std::ptrdiff_t far = near + side;
  if (near < 0 || far < 0 || near >= rows || far >= rows) return false;
  const double last = value[static_cast<std::size_t>(near)];
  const double slope = last - value[static_cast<std::size_t>(far)];
  const double line = last + slope * static_cast<double>(std::abs(at_row - near));
  return std::abs(value[k] - line) < 0.5 * std::abs(off[k]);
}

/// Finds spikes: readings that jump away and back by more than noise and motion explain.
void find_spikes(std::span<const double> all, ChannelQuality& quality) {
  std::vector<std::size_t> rows;
  std::vector<double> value;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!quality.fresh[i]) continue;
    rows.push_back(i);
    value.push_back(all[i]);
  }
  constexpr std::size_t kMin = 20;
  if (rows.size() < kMin) return;
  const std::vector<double> off = off_median(value);
  const double limit = spike_limit(value, off, quality.quantum);
  for (std::size_t k = 0; k < off.size(); ++k) {
    if (std::abs(off[k]) <= limit || !(limit > 0.0)) continue;
    if (is_reached_from(value, off, limit, k, -1) || is_reached_from(value, off, limit, k, 1))
      continue;
    quality.spikes.push_back(rows[k]);
    quality.fresh[rows[k]] = false;
  }
}

/// Values up to this fraction of the signal's largest magnitude count as 0: the vehicle is at rest.
constexpr double kRestShare = 1e-6;

/// Divides the values into runs of equal successive values.
std::vector<RowSpan> equal_runs(std::span<const double> value) {
  std::vector<RowSpan> runs;
  for (std::size_t i = 0; i < value.size();) {
    std::size_t end = i + 1;
    while (end < value.size() && value[end] == value[i]) ++end;
    runs.push_back({i, end});
    i = end;
  }
  return runs;
}

}  // namespace

std::vector<RowSpan> long_constant_runs(std::span<const double> t_s,
                                        std::span<const double> value) {
  constexpr double kLong_s = 1.0;
  constexpr double kTimesUsual = 8.0;
  std::vector<RowSpan> runs = equal_runs(value);
  std::vector<double> lengths;
  for (const RowSpan& run : runs) lengths.push_back(static_cast<double>(run.end - run.begin));
  const double shortest = kTimesUsual * quantile(lengths, 0.9);
  std::erase_if(runs, [&](const RowSpan& run) {
    return static_cast<double>(run.end - run.begin) < shortest ||
           t_s[run.end - 1] - t_s[run.begin] < kLong_s;
  });
  return runs;
}

namespace {

/// Returns the time, s, during which the command in `run` differs by more than `notable` from its
/// value at the start of `run`. Compares means over 0.3 s, because a speed controller changes its
/// command in every row, although the mean stays about the same. Leaves out the last 0.3 s of the
/// run.
double changed_s(std::span<const double> t_s, std::span<const double> activity, const RowSpan& run,
                 double notable) {
  constexpr double kMean_s = 0.3;
  double changed = 0.0;
  double sum = 0.0;
  std::optional<double> first_mean;
  std::size_t from = run.begin;
  for (std::size_t i = run.begin; i < run.end; ++i) {
    sum += activity[i];
    while (t_s[i] - t_s[from] > kMean_s) sum -= activity[from++];
    const double mean = sum / static_cast<double>(i - from + 1);
    if (t_s[i] - t_s[run.begin] < kMean_s) continue;
    if (!first_mean) first_mean = mean;
    if (t_s[i] >= t_s[run.end - 1] - kMean_s) break;
    if (std::abs(mean - *first_mean) > notable) changed += t_s[i] - t_s[i - 1];
  }
  return changed;
}

/// Finds stuck values. A value is stuck if it is constant for long (long_constant_runs()), and the
/// command changed for 0.3 s or more in this time.
/// Not stuck are values near 0 (the vehicle rests; find_stuck_at_zero()), and values that stay
/// constant so long more than once (set-points).
void find_stuck(std::span<const double> t_s, std::span<const double> value,
                std::span<const double> activity, ChannelQuality& quality) {
  const auto [low, high] = std::minmax_element(activity.begin(), activity.end());
  const double notable = 0.2 * (*high - *low);
  const double rest = kRestShare * largest_size(value);
  const auto is_resting = [&](double reading) { return std::abs(reading) <= rest; };
  std::vector<RowSpan> long_runs;
  std::map<double, int> times_held;
  for (const RowSpan& run : long_constant_runs(t_s, value)) {
    if (is_resting(value[run.begin])) continue;
    long_runs.push_back(run);
    ++times_held[value[run.begin]];
  }
  for (const RowSpan& run : long_runs) {
    if (times_held[value[run.begin]] > 1) continue;
    constexpr double kMinChanged_s = 0.3;
    const bool is_notable =
        notable > 0.0 && changed_s(t_s, activity, run, notable) >= kMinChanged_s;
    if (!is_notable) continue;
    quality.stuck.push_back(run);
    // The first reading of a stuck run is valid; the repetitions after it are no measurements.
    for (std::size_t i = run.begin + 1; i < run.end; ++i) quality.fresh[i] = false;
  }
}

/// Distinct values of a channel.
struct Levels {
  std::size_t count = 0;
  /// Largest number of rows with one value, apart from the smallest and the largest value, and from
  /// values up to `rest` in magnitude.
  std::size_t most_elsewhere = 0;
};

Levels levels_of(std::vector<double> value, double rest) {
  Levels levels;
  std::sort(value.begin(), value.end());
  for (const RowSpan& run : equal_runs(value)) {
    const double level = value[run.begin];
    ++levels.count;
    if (level != value.front() && level != value.back() && std::abs(level) > rest) {
      levels.most_elsewhere = std::max(levels.most_elsewhere, run.end - run.begin);
    }
  }
  return levels;
}

/// True if the number of distinct values is more than a tenth of the number of changes. A coarse
/// sensor, such as an encoder that counts few ticks per row, has fewer.
bool has_many_values(std::span<const double> value, const Changes& changes) {
  constexpr double kMany = 0.1;
  const Levels levels = levels_of({value.begin(), value.end()}, 0.0);
  return static_cast<double>(levels.count) > kMany * static_cast<double>(changes.row.size());
}

/// True if the share of `gaps` that are 2 is about the same in all parts of the log: its variance
/// between blocks of 40 gaps is at most half the binomial variance, the one of random gaps. (The
/// rows of a sensor with a fixed rate are more regular than random ones. The share varies if a
/// value changes when the vehicle has moved by a step, so that the rate depends on the speed.)
/// Needs at least three blocks.
bool is_steady_share_of_two(const std::vector<double>& gaps, double share) {
  constexpr std::size_t kBlock = 40;
  double squares = 0.0;
  std::size_t blocks = 0;
  for (std::size_t begin = 0; begin + kBlock <= gaps.size(); begin += kBlock, ++blocks) {
    const auto first = gaps.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto twos = std::count(first, first + static_cast<std::ptrdiff_t>(kBlock), 2.0);
    squares += std::pow(static_cast<double>(twos) / kBlock - share, 2);
  }
  constexpr std::size_t kFewest = 3;
  return blocks >= kFewest &&
         squares <= 0.5 * static_cast<double>(blocks) * share * (1.0 - share) / kBlock;
}

/// True for a sensor whose rate is between half the rate of the log and this rate, so that each
/// reading stands in one or two rows, at least a tenth of them in two:
///   - nine tenths of the changes are one or two rows apart, with is_steady_share_of_two();
///   - changes two rows apart are at least four times as many as the resolution explains. (Readings
///     with normal noise whose changes have the median m are rounded to equal values with a
///     probability of 0.27 r/m, for the resolution r.)
bool is_in_one_or_two_rows(std::span<const double> value, const Changes& changes) {
  constexpr double kSome = 0.1;
  constexpr double kTimes = 4.0;
  constexpr double kPerResolution = 0.27;
  const auto once = static_cast<double>(std::ranges::count(changes.gap, 1.0));
  const auto twice = static_cast<double>(std::ranges::count(changes.gap, 2.0));
  const auto count = static_cast<double>(changes.gap.size());
  if (once + twice < (1.0 - kSome) * count || !has_many_values(value, changes)) return false;
  const double resolution = *std::ranges::min_element(changes.step);
  const double by_chance = kPerResolution * resolution / median(changes.step);
  const double share = twice / count;
  return share > std::max(kSome, kTimes * by_chance) && is_steady_share_of_two(changes.gap, share);
}

/// Finds saturation of the sensor. Criterion: the largest or the smallest value of the channel
/// occurs at least four times as often as any value between these two. It must occur in at least 8
/// rows and 0.5 % of the rows. Leaves out rows without a command, because a vehicle at rest also
/// repeats a value.
void find_saturation(std::span<const double> all, std::span<const double> activity,
                     ChannelQuality& quality) {
  const double idle = 0.02 * largest_size(activity);
  std::vector<double> value;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::abs(activity[i]) > idle) value.push_back(all[i]);
  }
  if (value.empty()) return;
  const double rest = kRestShare * largest_size(value);
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  const Levels levels = levels_of(value, rest);
  // A signal with few distinct values repeats each of them often. A repeated largest value then
  // does not show saturation.
  constexpr std::size_t kMinLevels = 20;
  if (levels.count < kMinLevels) return;
  for (const double bound : {*high, *low}) {
    if (std::abs(bound) <= rest) continue;
    const auto count = static_cast<std::size_t>(std::count(value.begin(), value.end(), bound));
    if (count < std::max<std::size_t>(8, value.size() / 200)) continue;
    if (count < 4 * levels.most_elsewhere) continue;
    if (count > quality.saturated) {
      quality.saturated = count;
      quality.saturated_at = bound;
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i] == bound) quality.fresh[i] = false;
    }
  }
}

}  // namespace

double largest_size(std::span<const double> values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

double resolution_of_changes(std::span<const double> readings) {
  constexpr std::size_t kFewest = 30;
  constexpr double kOneStep = 1.5;
  const Changes changes = changes_of(readings);
  if (changes.row.size() < kFewest) return 0.0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    if (readings[i] == readings[i - 1] && readings[i] != 0.0) return 0.0;
  }
  const double quantum = quantum_of(changes);
  return median(changes.step) < kOneStep * quantum ? quantum : 0.0;
}

ChannelQuality find_repeats(std::span<const double> value) {
  ChannelQuality quality;
  const Changes changes = changes_of(value);
  quality.fresh.assign(value.size(), true);
  constexpr std::size_t kMinChanges = 8;
  if (changes.row.size() < kMinChanges) return quality;
  const double moving = static_cast<double>(changes.row.back() - changes.row.front());
  const double repeated = moving - static_cast<double>(changes.row.size() - 1);
  const double quantum = quantum_of(changes);
  // The sensor is slower than the log if 95 % of the changes are at least two rows apart.
  const bool is_slow =
      (quantile(changes.gap, 0.05) >= 2.0 && !changes_step_by_step(changes, quantum)) ||
      (quantum == 0.0 && is_in_one_or_two_rows(value, changes));
  if (is_slow) {
    quality.repeats = Repeats::kSlow;
    quality.fresh = slow_readings(changes, value.size());
    quality.quantum = quantum;
  } else if (quantum > 0.0 && repeated > kSomeRepeats * moving) {
    quality.repeats = Repeats::kCoarse;
    quality.quantum = quantum;
  }
  return quality;
}

namespace {

/// True if all values are multiples of their smallest magnitude above 0, and this is at least 1 %
/// of the largest magnitude.
bool is_on_coarse_grid(std::span<const double> value) {
  constexpr double kCoarse = 0.01;
  // The file may give the values with few digits.
  constexpr double kOffGrid = 0.05;
  double smallest = 0.0;
  for (const double v : value) {
    const double size = std::abs(v);
    if (size > 0.0 && (smallest == 0.0 || size < smallest)) smallest = size;
  }
  if (!(smallest > 0.0) || smallest < kCoarse * largest_size(value)) return false;
  return std::ranges::all_of(value, [&](double v) {
    const double times = v / smallest;
    return std::abs(times - std::round(times)) < kOffGrid;
  });
}

/// First row of the end of a rest (leave_out_rest()).
std::size_t end_of_rest(std::span<const double> t_s, std::span<const double> activity,
                        const RowSpan& run) {
  constexpr double kEnd_s = 0.3;
  std::size_t row = run.end;
  while (row > run.begin + 1 && t_s[run.end - 1] - t_s[row - 1] < kEnd_s) {
    --row;
    if (activity[row] != activity[row - 1]) break;
  }
  return row;
}

}  // namespace

void leave_out_rest(std::span<const double> t_s, std::span<const double> value,
                    std::span<const double> activity, ChannelQuality& quality) {
  constexpr std::size_t kRestRows = 10;
  constexpr std::size_t kFirst = 3;
  constexpr double kEvery_s = 1.0;
  if (!is_on_coarse_grid(value)) return;
  for (const RowSpan& run : equal_runs(value)) {
    if (value[run.begin] != 0.0 || run.end - run.begin < kRestRows) continue;
    const std::size_t end = end_of_rest(t_s, activity, run);
    double last_s = t_s[run.begin + kFirst - 1];
    for (std::size_t i = run.begin + kFirst; i < end; ++i) {
      if (t_s[i] - last_s >= kEvery_s) {
        last_s = t_s[i];
      } else {
        quality.fresh[i] = false;
      }
    }
  }
}

ChannelQuality channel_quality(std::span<const double> t_s, std::span<const double> value,
                               std::span<const double> activity) {
  ChannelQuality quality = find_repeats(value);
  find_spikes(value, quality);
  find_stuck(t_s, value, activity, quality);
  if (quality.repeats == Repeats::kNone && quality.stuck.empty())
    find_saturation(value, activity, quality);
  return quality;
}

}  // namespace awmr
