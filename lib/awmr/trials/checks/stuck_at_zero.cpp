#include <algorithm>
#include <cmath>

#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/trials/checks/channel_quality.h"
#include "awmr/trials/resampling/even_times.h"

namespace awmr {
namespace {

/// Long run of readings that are exactly 0.
struct ZeroRun {
  RowSpan rows;
  double before = 0.0;  ///< magnitude of the reading in the row before; 0: none, or a time gap
  double after = 0.0;   ///< magnitude of the reading in the row after; 0: none, or a time gap
};

/// Finds the runs of zeros among long_constant_runs().
std::vector<ZeroRun> long_zero_runs(std::span<const double> t_s, std::span<const double> value) {
  constexpr double kGap = 2.5;  // a longer time between rows, in median steps, may hide a stop
  const double gap_s = kGap * median_step_of(t_s);
  const auto near = [&](std::size_t row, std::size_t zero_row) {
    return std::abs(t_s[row] - t_s[zero_row]) <= gap_s ? std::abs(value[row]) : 0.0;
  };
  std::vector<ZeroRun> found;
  for (const auto& [begin, end] : long_constant_runs(t_s, value)) {
    if (value[begin] != 0.0) continue;
    found.push_back({{begin, end},
                     begin > 0 ? near(begin - 1, begin) : 0.0,
                     end < value.size() ? near(end, end - 1) : 0.0});
  }
  return found;
}

/// Smallest reading next to the zeros of `run` that counts as a jump. It is the largest of these
/// values:
///   - three times the 99 % quantile of the change between readings elsewhere in the log;
///   - a fifth of the largest reading;
///   - three times the resolution.
double jump_limit(std::span<const double> value, const ChannelQuality& quality,
                  const ZeroRun& run) {
  constexpr double kTimesUsual = 3.0;
  constexpr double kMinShare = 0.2;
  std::vector<double> changes;
  double last = value.front();
  bool is_next_to_run = true;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const bool is_in_run = i >= run.rows.begin && i < run.rows.end;
    if (is_in_run) is_next_to_run = true;
    if (is_in_run || !quality.fresh[i]) continue;
    if (!is_next_to_run) changes.push_back(std::abs(value[i] - last));
    last = value[i];
    is_next_to_run = false;
  }
  const double usual = changes.empty() ? 0.0 : quantile(changes, 0.99);
  return std::max({kTimesUsual * usual, kMinShare * largest_size(value), 3.0 * quality.quantum});
}

/// True if at least 1 % of the readings are smaller than half of `jump`, but not 0. A sensor that
/// reports 0 below a threshold, such as a GPS receiver, jumps to 0 from this threshold.
bool reads_smaller_values(std::span<const double> value, const ChannelQuality& quality,
                          double jump) {
  constexpr double kSome = 0.01;
  std::size_t all = 0;
  std::size_t smaller = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!quality.fresh[i] || value[i] == 0.0) continue;
    ++all;
    if (std::abs(value[i]) < 0.5 * jump) ++smaller;
  }
  return static_cast<double>(smaller) > kSome * static_cast<double>(all);
}

/// True if the commands in the run would move the vehicle: for 0.5 s, they are at least half as
/// large as the median command in the rows with a reading of more than half of `jump`. Leaves out
/// the last 0.5 s of the run, because the vehicle and the sensor respond with a delay.
bool is_driven(std::span<const double> t_s, std::span<const double> value,
               std::span<const double> activity, const ZeroRun& run, double jump) {
  constexpr double kResponse_s = 0.5;
  constexpr double kDriven_s = 0.5;
  std::vector<double> commands;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (std::abs(value[i]) > 0.5 * jump) commands.push_back(std::abs(activity[i]));
  }
  const double driving = 0.5 * median(std::move(commands));
  if (!(driving > 0.0)) return false;
  const double end_s = t_s[run.rows.end - 1] - kResponse_s;
  double driven_s = 0.0;
  for (std::size_t i = run.rows.begin; t_s[i] < end_s; ++i) {
    if (std::abs(activity[i]) >= driving) driven_s += t_s[i + 1] - t_s[i];
  }
  return driven_s >= kDriven_s;
}

}  // namespace

void find_stuck_at_zero(std::span<const double> t_s, std::span<const double> value,
                        std::span<const double> activity, ChannelQuality& quality) {
  const std::vector<ZeroRun> runs = long_zero_runs(t_s, value);
  const double smallest = 0.2 * largest_size(value);
  std::vector<RowSpan> stuck;
  for (const ZeroRun& run : runs) {
    const double jump = std::max(run.before, run.after);
    if (run.rows.begin == 0 || jump <= smallest) continue;
    const double limit = jump_limit(value, quality, run);
    const bool jumps_twice = std::min(run.before, run.after) > limit;
    if (jump <= limit || (!jumps_twice && runs.size() > 1)) continue;
    if (!reads_smaller_values(value, quality, jump)) continue;
    if (is_driven(t_s, value, activity, run, jump)) stuck.push_back(run.rows);
  }
  for (const RowSpan& rows : stuck) {
    for (std::size_t i = rows.begin; i < rows.end; ++i) quality.fresh[i] = false;
  }
  quality.stuck_at_zero = std::move(stuck);
}

}  // namespace awmr
