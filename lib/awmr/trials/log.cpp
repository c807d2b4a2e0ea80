#include "awmr/trials/log.h"

#include <fmt/format.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <cmath>

#include "awmr/core/csv_text.h"
#include "awmr/core/units.h"
#include "awmr/trials/channel_quality.h"
#include "awmr/trials/read_trials.h"
#include "awmr/trials/robust_ratio.h"
#include "trial_reader.h"

namespace awmr {
namespace {

const CsvColumn kColumns[] = {{"t_s", true},
                              {"force_left", true},
                              {"force_right", true},
                              {"x_m", false},
                              {"y_m", false},
                              {"heading_deg", false},
                              {"speed_mps", false},
                              {"sway_mps", false},
                              {"yaw_rate_radps", false},
                              {"steering_deg", false},
                              {"steering_cmd_deg", false},
                              {"latitude_deg", false},
                              {"longitude_deg", false}};

constexpr std::size_t kShortestLog = 10;

std::vector<double> values_of(const TrialReader& reader, std::string_view column, double scale) {
  const std::span<const double> cells = reader.table().column(column);
  std::vector<double> values(cells.begin(), cells.end());
  for (double& value : values) value *= scale;
  return values;
}

/// Adds whole turns so that no step is larger than half of one.
void unwrap(std::vector<double>& angle_rad) {
  const double turn = 2.0 * pi<double>();
  double turns = 0.0;
  double previous = angle_rad.empty() ? 0.0 : angle_rad.front();
  for (double& angle : angle_rad) {
    const double raw = angle;
    turns -= std::round((raw - previous) / turn);
    previous = raw;
    angle = raw + turn * turns;
  }
}

/// The times of the first few rows, for a message.
std::string times_of(const DrivingLog& log, const std::vector<std::size_t>& rows) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, rows.size()); ++i) {
    text += fmt::format("{}{:.4g} s", i == 0 ? "" : ", ", log.t_s[rows[i]]);
  }
  return rows.size() > kMost ? text + ", ..." : text;
}

void note_quality(LogChannel channel, const DrivingLog& log, const ChannelQuality& quality,
                  std::vector<Finding>& findings) {
  const ChannelInfo& about = info(channel);
  const auto warn = [&](std::size_t row, const char* code, std::string message) {
    findings.push_back({log.file, log.line[row], Severity::kWarning, code, std::move(message)});
  };
  if (!quality.spikes.empty()) {
    warn(quality.spikes.front(), "spikes",
         fmt::format("{}: {} readings jump away and back (spikes, at {}); they are set aside",
                     about.column, quality.spikes.size(), times_of(log, quality.spikes)));
  }
  for (const RowSpan& span : quality.stuck) {
    warn(span.begin, "stuck-sensor",
         fmt::format("{} is stuck at one value from {:.4g} s to {:.4g} s while the commands "
                     "changed; these rows are set aside",
                     about.column, log.t_s[span.begin], log.t_s[span.end - 1]));
  }
  if (quality.saturated > 0) {
    warn(0, "saturated-channel",
         fmt::format("{} reads {:.4g} in {} rows and nothing beyond: the end of its range "
                     "(saturated); these rows are set aside, and rows near it lean to one side",
                     about.column, quality.saturated_at / about.to_si, quality.saturated));
  }
  if (quality.repeats == Repeats::kCoarse) {
    warn(0, "quantised-samples",
         fmt::format("{} comes in steps of {:.4g}, a coarse (quantised) sensor: every row counts, "
                     "and the rounding counts as its error",
                     about.column, quality.quantum / about.to_si));
  }
}

/// What the vehicle is told to do that shows in a channel: thrust in speeds, turning in the rest.
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

Measured measured_of(LogChannel channel, const DrivingLog& log, std::vector<double> values,
                     std::vector<Finding>& findings) {
  ChannelQuality quality = channel_quality(log.t_s, values, activity_for(channel, log));
  note_quality(channel, log, quality, findings);
  const auto fresh = static_cast<int>(std::count(quality.fresh.begin(), quality.fresh.end(), true));
  return {std::move(values), std::move(quality.fresh), fresh, quality.repeats == Repeats::kSlow,
          quality.repeats == Repeats::kCoarse ? quality.quantum : 0.0};
}

void check_columns(TrialReader& reader) {
  if (!reader.has("steering_cmd_deg") && !reader.has("steering_deg")) {
    reader.header_fault("no steering: add a column steering_cmd_deg or steering_deg");
  }
  if (reader.has("latitude_deg") != reader.has("longitude_deg")) {
    reader.header_fault("latitude_deg and longitude_deg go together");
  }
  if (reader.has("latitude_deg") && (reader.has("x_m") || reader.has("y_m"))) {
    reader.header_fault("a position twice: give x_m and y_m, or latitude_deg and longitude_deg");
  }
  const auto has = [&](const char* column) { return reader.has(column); };
  if (!has("x_m") && !has("y_m") && !has("heading_deg") && !has("speed_mps") && !has("sway_mps") &&
      !has("yaw_rate_radps") && !has("latitude_deg")) {
    reader.header_fault(
        "nothing measured: add any of x_m, y_m, heading_deg, speed_mps, sway_mps, yaw_rate_radps");
  }
}

void check_time(TrialReader& reader) {
  const std::span<const double> t_s = reader.table().column("t_s");
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    if (t_s[i] > t_s[i - 1]) continue;
    reader.fault(i, "t_s", fmt::format("found {} after {}: time has to rise", t_s[i], t_s[i - 1]));
  }
  if (t_s.size() < kShortestLog) {
    reader.header_fault(
        fmt::format("this log has {} rows; at least {} are needed", t_s.size(), kShortestLog));
  }
}

/// East and north of the first row, by the library's local tangent plane.
void add_geographic(TrialReader& reader, DrivingLog& log, std::vector<Finding>& findings) {
  const std::vector<double> latitude = values_of(reader, "latitude_deg", 1.0);
  const std::vector<double> longitude = values_of(reader, "longitude_deg", 1.0);
  for (std::size_t i = 0; i < latitude.size(); ++i) {
    if (std::abs(latitude[i]) > 90.0) {
      reader.fault(i, "latitude_deg", fmt::format("found {}, outside [-90, 90]", latitude[i]));
    }
    if (std::abs(longitude[i]) > 360.0) {
      reader.fault(i, "longitude_deg", fmt::format("found {}, outside [-360, 360]", longitude[i]));
    }
  }
  if (!reader.faults().empty()) return;
  const GeographicLib::LocalCartesian plane(latitude.front(), longitude.front(), 0.0);
  std::vector<double> east(latitude.size());
  std::vector<double> north(latitude.size());
  for (std::size_t i = 0; i < latitude.size(); ++i) {
    double up = 0.0;
    plane.Forward(latitude[i], longitude[i], 0.0, east[i], north[i], up);
  }
  log[LogChannel::kX] = measured_of(LogChannel::kX, log, std::move(east), findings);
  log[LogChannel::kY] = measured_of(LogChannel::kY, log, std::move(north), findings);
}

/// A receiver gives x and y together: a repeat of one alone is chance.
void join_position(DrivingLog& log) {
  if (!log[LogChannel::kX] || !log[LogChannel::kY]) return;
  Measured& x = *log[LogChannel::kX];
  Measured& y = *log[LogChannel::kY];
  x.held = y.held = x.held || y.held;
  if (!x.held) return;
  for (std::size_t i = 1; i < log.rows(); ++i) {
    const bool new_x = x.value[i] != x.value[i - 1];
    const bool new_y = y.value[i] != y.value[i - 1];
    // A new value that does not count was set aside, and its partner goes with it.
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
         fmt::format("{} repeats its value between updates: the {} new values ({:.3g} Hz) are used",
                     info(channel).column, log[channel]->fresh_count,
                     log[channel]->fresh_count / duration_s)});
  }
}

void note_gaps(const DrivingLog& log, std::vector<Finding>& findings) {
  const double longest_s = kGapSteps * log.median_step_s();
  for (std::size_t i = 1; i < log.rows(); ++i) {
    const double step_s = log.t_s[i] - log.t_s[i - 1];
    if (step_s <= longest_s) continue;
    findings.push_back({log.file, log.line[i], Severity::kNote, "log-gap",
                        fmt::format("nothing logged for {:.3g} s before this row: what was "
                                    "commanded then is unknown, and the fit starts anew here",
                                    step_s)});
  }
}

}  // namespace

const ChannelInfo& info(LogChannel channel) {
  static constexpr double kDegree = pi<double>() / 180.0;
  static constexpr std::array<ChannelInfo, kChannelCount> kTable{
      {{"x_m", "x_m", "m", 1.0},
       {"y_m", "y_m", "m", 1.0},
       {"heading_deg", "heading_rad", "rad", kDegree},
       {"speed_mps", "speed_mps", "m/s", 1.0},
       {"sway_mps", "sway_mps", "m/s", 1.0},
       {"yaw_rate_radps", "yaw_rate_radps", "rad/s", 1.0},
       {"steering_deg", "steering_rad", "rad", kDegree}}};
  return kTable[static_cast<std::size_t>(channel)];
}

double DrivingLog::median_step_s() const {
  std::vector<double> steps;
  for (std::size_t i = 1; i < t_s.size(); ++i) steps.push_back(t_s[i] - t_s[i - 1]);
  return median(std::move(steps));
}

const std::vector<double>& DrivingLog::driving_steering_rad() const {
  return steering_command_rad ? *steering_command_rad : (*this)[LogChannel::kSteering]->value;
}

Result<DrivingLog> read_log(const std::filesystem::path& path, const TrialOptions& options,
                            std::vector<Finding>& findings) {
  AWMR_ASSIGN_OR_RETURN(CsvTable table, read_csv(path, kColumns, options.columns));
  TrialReader reader(std::move(table), options);
  check_columns(reader);
  check_time(reader);
  DrivingLog log;
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));

  log.file = finding_file(reader.table());
  for (std::size_t i = 0; i < reader.table().rows(); ++i)
    log.line.push_back(reader.table().line(i));
  log.t_s = values_of(reader, "t_s", 1.0);
  log.force_left = values_of(reader, "force_left", 1.0);
  log.force_right = values_of(reader, "force_right", 1.0);
  if (reader.has("steering_cmd_deg")) {
    log.steering_command_rad =
        values_of(reader, "steering_cmd_deg", info(LogChannel::kSteering).to_si);
  }
  if (reader.has("latitude_deg")) add_geographic(reader, log, findings);
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));
  for (const LogChannel channel : kChannels) {
    const ChannelInfo& about = info(channel);
    if (!reader.has(about.column)) continue;
    std::vector<double> values = values_of(reader, about.column, about.to_si);
    if (channel == LogChannel::kHeading) unwrap(values);
    log[channel] = measured_of(channel, log, std::move(values), findings);
  }
  join_position(log);
  note_held(log, findings);
  note_gaps(log, findings);
  return log;
}

}  // namespace awmr
