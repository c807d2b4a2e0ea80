#include "log_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/trials/checks/channel_quality.h"
#include "awmr/trials/resampling/even_times.h"

namespace awmr {
namespace {

/// Formats the times of the first few rows for a message.
std::string times_of(const DrivingLog& log, const std::vector<std::size_t>& rows) {
  constexpr std::size_t kMax = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMax, rows.size()); ++i) {
    text += fmt::format("{}{:.4g} s", i == 0 ? "" : ", ", log.t_s[rows[i]]);
  }
  return rows.size() > kMax ? text + ", ..." : text;
}

void note_quality(LogChannel channel, const DrivingLog& log, const ChannelQuality& quality,
                  std::vector<Finding>& findings) {
  const ChannelInfo& about = info(channel);
  const auto warn = [&](std::size_t row, const char* code, std::string message) {
    findings.push_back({log.file, log.line[row], Severity::kWarning, code, std::move(message)});
  };
  if (!quality.spikes.empty()) {
    warn(quality.spikes.front(), "spikes",
         fmt::format("{}: {} readings jump away and back (spikes, at {}); these readings are not "
                     "used. Check the connection of the sensor",
                     about.column, quality.spikes.size(), times_of(log, quality.spikes)));
  }
  for (const RowSpan& span : quality.stuck) {
    warn(span.begin, "stuck-sensor",
         fmt::format("{} is stuck at one value from {:.4g} s to {:.4g} s while the commands "
                     "changed; these readings are not used. Check the sensor and its connection",
                     about.column, log.t_s[span.begin], log.t_s[span.end - 1]));
  }
  for (const RowSpan& span : quality.stuck_at_zero) {
    warn(
        span.begin, "stuck-sensor",
        fmt::format("{} is stuck at 0 from {:.4g} s to {:.4g} s: it jumps to or from 0 between two "
                    "rows, and the commands drive the vehicle; these readings are not used. Check "
                    "the sensor and its connection",
                    about.column, log.t_s[span.begin], log.t_s[span.end - 1]));
  }
  if (quality.saturated > 0) {
    warn(0, "saturated-channel",
         fmt::format("{} is {:.4g} in {} rows and never beyond: the end of the sensor's range "
                     "(saturated). These readings are not used, and readings near this value are "
                     "biased; drive more gently, or use a sensor with a larger range",
                     about.column, quality.saturated_at / about.to_si, quality.saturated));
  }
  if (quality.repeats == Repeats::kCoarse) {
    warn(0, "quantised-samples",
         fmt::format(
             "{} changes only in steps of {:.4g}: a coarse (quantised) sensor. Nothing needs to be "
             "done: the fit uses every row, and includes the rounding in the error of the sensor",
             about.column, quality.quantum / about.to_si));
  }
}

/// True for a channel that is 0 if the vehicle is at rest.
bool is_rate(LogChannel channel) {
  return channel == LogChannel::kSpeed || channel == LogChannel::kYawRate;
}

/// Returns, for each row, the command that moves a channel, in an arbitrary unit. Heading and yaw
/// rate: about the yaw moment, from force difference and steering. Other channels: the thrust.
std::vector<double> activity_for(LogChannel channel, const DrivingLog& log) {
  const bool turning = channel == LogChannel::kHeading || channel == LogChannel::kYawRate;
  std::vector<double> activity(log.rows());
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double sum = log.force_left[i] + log.force_right[i];
    const double apart = log.force_right[i] - log.force_left[i];
    const double angle = log.steering_command_rad ? (*log.steering_command_rad)[i] : 0.0;
    activity[i] = turning ? apart + sum * angle : sum;
  }
  return activity;
}

/// Computes channel_quality(), and for speed and yaw rate find_stuck_at_zero(), for a channel that
/// has values only in `rows`. In the result for all rows of the log, rows without a value are no
/// measurements.
ChannelQuality quality_in(const std::vector<std::size_t>& rows, LogChannel channel,
                          const DrivingLog& log, const std::vector<double>& values) {
  const std::vector<double> activity = activity_for(channel, log);
  const auto check = [&](const auto& t_s, const auto& value, const auto& commands) {
    ChannelQuality quality = channel_quality(t_s, value, commands);
    if (is_rate(channel)) find_stuck_at_zero(t_s, value, commands, quality);
    return quality;
  };
  if (rows.size() == log.rows()) return check(log.t_s, values, activity);
  ChannelQuality quality =
      check(picked(log.t_s, rows), picked(values, rows), picked(activity, rows));
  std::vector<bool> fresh(log.rows(), false);
  for (std::size_t i = 0; i < rows.size(); ++i) fresh[rows[i]] = quality.fresh[i];
  quality.fresh = std::move(fresh);
  for (std::size_t& spike : quality.spikes) spike = rows[spike];
  for (std::vector<RowSpan>* const spans : {&quality.stuck, &quality.stuck_at_zero}) {
    for (RowSpan& span : *spans) span = {rows[span.begin], rows[span.end - 1] + 1};
  }
  return quality;
}

/// True if at least 80 % of the time spans between successive `rows` are about equal. This is so
/// for a slow sensor, or if only the rows of a gap lack a reading.
bool are_regular(const std::vector<double>& t_s, const std::vector<std::size_t>& rows) {
  constexpr double kAbout = 1.5;  // time spans that differ by less than this factor count as equal
  constexpr double kMost = 0.8;
  const std::vector<double> gaps_s = steps_of(picked(t_s, rows));
  if (gaps_s.empty()) return true;
  const double usual_s = median(gaps_s);
  const auto usual = std::ranges::count_if(
      gaps_s, [&](double gap_s) { return gap_s < kAbout * usual_s && usual_s < kAbout * gap_s; });
  return static_cast<double>(usual) >= kMost * static_cast<double>(gaps_s.size());
}

void note_changes_only(LogChannel channel, const DrivingLog& log,
                       const std::vector<std::size_t>& rows, double resolution,
                       std::vector<Finding>& findings) {
  const ChannelInfo& about = info(channel);
  findings.push_back(
      {log.file, 0, Severity::kNote, "only-changes",
       fmt::format("{} has {} values in {} rows; each value differs from the value before, "
                   "mostly by the resolution of {:.3g}. awmr uses each value until the next one",
                   about.column, rows.size(), log.rows(), resolution / about.to_si)});
}

std::vector<std::size_t> rows_between(std::size_t first, std::size_t last) {
  std::vector<std::size_t> rows(last + 1 - first);
  std::iota(rows.begin(), rows.end(), first);
  return rows;
}

/// Fills gaps: gives each row that is not in `rows` the value of the last row in `rows` before it.
/// Leaves values before the first of `rows` unchanged.
std::vector<double> held_between(const std::vector<std::size_t>& rows, std::vector<double> values) {
  auto next = rows.begin();
  for (std::size_t i = rows.front() + 1; i < values.size(); ++i) {
    if (next + 1 != rows.end() && *(next + 1) == i) {
      ++next;
    } else {
      values[i] = values[*next];
    }
  }
  return values;
}

}  // namespace

Measured measured_of(LogChannel channel, const DrivingLog& log,
                     const std::vector<std::size_t>& rows, std::vector<double> values,
                     std::vector<Finding>& findings) {
  const bool is_sparse = !rows.empty() && rows.size() < rows.back() + 1 - rows.front();
  const double resolution =
      is_sparse && !are_regular(log.t_s, rows) ? resolution_of_changes(picked(values, rows)) : 0.0;
  if (resolution > 0.0) {
    note_changes_only(channel, log, rows, resolution, findings);
    return measured_of(channel, log, rows_between(rows.front(), rows.back()),
                       held_between(rows, std::move(values)), findings);
  }
  ChannelQuality quality = quality_in(rows, channel, log, values);
  if (is_rate(channel)) {
    leave_out_rest(log.t_s, values, activity_for(channel, log), quality);
  }
  note_quality(channel, log, quality, findings);
  const auto fresh = static_cast<int>(std::count(quality.fresh.begin(), quality.fresh.end(), true));
  return {std::move(values), std::move(quality.fresh), fresh, quality.repeats == Repeats::kSlow,
          quality.repeats == Repeats::kCoarse ? quality.quantum : 0.0};
}

void join_position(DrivingLog& log) {
  if (!log[LogChannel::kX] || !log[LogChannel::kY]) return;
  Measured& x = *log[LogChannel::kX];
  Measured& y = *log[LogChannel::kY];
  x.held = y.held = x.held || y.held;
  if (!x.held) return;
  for (std::size_t i = 1; i < log.rows(); ++i) {
    const bool new_x = x.value[i] != x.value[i - 1];
    const bool new_y = y.value[i] != y.value[i - 1];
    // If a new value of x or of y is a spike or saturated, neither x nor y of this row is used.
    const bool set_aside = (new_x && !x.fresh[i]) || (new_y && !y.fresh[i]);
    x.fresh[i] = y.fresh[i] = (new_x || new_y) && !set_aside;
  }
  x.fresh_count = y.fresh_count =
      static_cast<int>(std::count(x.fresh.begin(), x.fresh.end(), true));
}

void note_held(const DrivingLog& log, std::vector<Finding>& findings) {
  const double duration_s = log.t_s.back() - log.t_s.front();
  for (const LogChannel channel : kChannels) {
    if (!log[channel] || !log[channel]->held) continue;
    findings.push_back(
        {log.file, 0, Severity::kNote, "held-samples",
         fmt::format(
             "{} repeats its value in several rows, because the sensor is slower than the log. "
             "Nothing needs to be done: the fit uses only the {} new values ({:.3g} Hz)",
             info(channel).column, log[channel]->fresh_count,
             log[channel]->fresh_count / duration_s)});
  }
}

void note_stale_command(std::string_view column, const DrivingLog& log,
                        const std::vector<std::size_t>& rows, std::vector<Finding>& findings) {
  constexpr double kLong_s = 1.0;
  if (rows.size() == log.rows()) return;
  std::vector<double> t_s = picked(log.t_s, rows);
  t_s.push_back(log.t_s.back());
  double longest_s = 0.0;
  double since_s = 0.0;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    if (t_s[i] - t_s[i - 1] <= longest_s) continue;
    longest_s = t_s[i] - t_s[i - 1];
    since_s = t_s[i - 1];
  }
  const double mean_s = (t_s.back() - t_s.front()) / static_cast<double>(t_s.size());
  if (longest_s < std::max(kLong_s, kGapSteps * mean_s)) return;
  findings.push_back(
      {log.file, 0, Severity::kWarning, "command-held",
       fmt::format(
           "{} has no new value for {:.3g} s from {:.4g} s on, and its last value is used for that "
           "time; leave this part out if the vehicle stops by itself without commands",
           column, longest_s, since_s)});
}

void note_gaps(const DrivingLog& log, std::vector<Finding>& findings) {
  const double longest_s = kGapSteps * log.median_step_s();
  for (std::size_t i = 1; i < log.rows(); ++i) {
    const double step_s = log.t_s[i] - log.t_s[i - 1];
    if (step_s <= longest_s) continue;
    findings.push_back(
        {log.file, log.line[i], Severity::kNote, "log-gap",
         fmt::format("nothing was logged for {:.3g} s before this row, so the commands of that "
                     "time are unknown. The fit restarts here from the measurements",
                     step_s)});
  }
}

}  // namespace awmr
