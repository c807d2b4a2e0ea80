#include "awmr/trials/log.h"

#include <fmt/format.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <algorithm>
#include <cmath>

#include "awmr/core/containers.h"
#include "awmr/core/csv.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/trials/checks/channel_quality.h"
#include "awmr/trials/checks/constant_channels.h"
#include "awmr/trials/checks/course_at_rest.h"
#include "awmr/trials/checks/log_channels.h"
#include "awmr/trials/formats/read_table.h"
#include "awmr/trials/log_start.h"
#include "awmr/trials/read_trials.h"
#include "awmr/trials/resampling/even_times.h"
#include "awmr/trials/resampling/interpolated_readings.h"
#include "awmr/trials/resampling/original_rows.h"
#include "awmr/trials/resampling/rounded_times.h"
#include "awmr/trials/trial_columns.h"
#include "trial_reader.h"

namespace awmr {
namespace {

/// Returns the values of a column in `rows`, times `scale`. If these are all rows of the table, the
/// values are moved out of the table, so each column may be requested only once.
std::vector<double> values_of(TrialReader& reader, RowSpan rows, std::string_view column,
                              double scale) {
  const std::span<const double> cells = reader.table().column(column);
  const bool are_all = rows.end - rows.begin == cells.size();
  std::vector<double> values =
      are_all ? reader.take(column)
              : std::vector<double>(cells.begin() + static_cast<std::ptrdiff_t>(rows.begin),
                                    cells.begin() + static_cast<std::ptrdiff_t>(rows.end));
  for (double& value : values) value *= scale;
  return values;
}

/// Indices of the rows with a value in the column, counted from the first row of the run.
std::vector<std::size_t> rows_present(const TrialReader& reader, RowSpan rows,
                                      std::string_view column) {
  const std::vector<bool>& present = reader.table().present(column);
  std::vector<std::size_t> found;
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    if (present.empty() || present[row]) found.push_back(row - rows.begin);
  }
  return found;
}

/// Adds whole turns, so that no change from row to row exceeds half a turn.
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

void check_log_columns(TrialReader& reader, bool has_steering) {
  if (has_steering && !reader.has("steering_cmd_deg") && !reader.has("steering_deg")) {
    reader.header_fault(ErrorCode::kMissing,
                        "no steering: add a column steering_cmd_deg or steering_deg, or set drive "
                        "to \"differential\" in vehicle.json if the vehicle has no steering");
  }
  if (reader.has("latitude_deg") != reader.has("longitude_deg")) {
    reader.header_fault(ErrorCode::kMissing,
                        "latitude_deg and longitude_deg belong together: add the missing column");
  }
  if (reader.has("latitude_deg") && (reader.has("x_m") || reader.has("y_m"))) {
    reader.header_fault(ErrorCode::kConflict,
                        "the position is given twice: keep either x_m and y_m, or latitude_deg "
                        "and longitude_deg");
  }
  const auto has = [&](const char* column) { return reader.has(column); };
  if (!has("x_m") && !has("y_m") && !has("heading_deg") && !has("speed_mps") && !has("sway_mps") &&
      !has("yaw_rate_radps") && !has("latitude_deg")) {
    reader.header_fault(
        ErrorCode::kMissing,
        "no measurement: add at least one of x_m, y_m, heading_deg, speed_mps, sway_mps, "
        "yaw_rate_radps, or latitude_deg and longitude_deg");
  }
}

/// Rows of each run. A run has consecutive rows with the same value of `run`; without that column
/// the file is one run.
std::vector<RowSpan> runs_of(const TrialReader& reader) {
  const std::size_t rows = reader.table().rows();
  std::vector<RowSpan> runs;
  for (std::size_t row = 0; row < rows; ++row) {
    const bool same = row > 0 && reader.cell(row, "run") == reader.cell(row - 1, "run");
    if (!same) runs.push_back({row, row});
    runs.back().end = row + 1;
  }
  return runs;
}

/// Returns the rows of `run`, from the first row with a steering angle on, if the log has
/// steering_deg but no steering_cmd_deg. The angle is then the steering input of the model, so rows
/// before its first value cannot be used.
RowSpan from_known_steering(TrialReader& reader, RowSpan run) {
  if (reader.has("steering_cmd_deg") || !reader.has("steering_deg")) return run;
  const std::vector<std::size_t> known = rows_present(reader, run, "steering_deg");
  if (known.empty()) {
    reader.header_fault(
        ErrorCode::kTooFewData,
        fmt::format("the run from line {} has no value of steering_deg, the steering input; "
                    "delete this run, or add steering_cmd_deg",
                    reader.table().line(run.begin)));
    return run;
  }
  run.begin += known.front();
  return run;
}

/// Returns the contiguous parts of a run whose times lie in options.used_s and outside all
/// intervals of options.excluded_s.
std::vector<RowSpan> used_parts(const TrialReader& reader, RowSpan run,
                                const TrialOptions& options) {
  const std::span<const double> t_s = reader.table().column("t_s");
  const auto is_used = [&](double t) {
    return options.used_s.contains(t) &&
           std::ranges::none_of(options.excluded_s,
                                [t](const Interval& span) { return span.contains(t); });
  };
  std::vector<RowSpan> parts;
  bool was_used = false;
  for (std::size_t row = run.begin; row < run.end; ++row) {
    const bool is = is_used(t_s[row]);
    if (is && !was_used) parts.push_back({row, row});
    if (is) parts.back().end = row + 1;
    was_used = is;
  }
  return parts;
}

/// Replaces each run by its used_parts(). Adds a fault if no part is left.
void keep_used(TrialReader& reader, const TrialOptions& options, std::vector<RowSpan>& runs) {
  std::vector<RowSpan> parts;
  for (const RowSpan run : runs) {
    append(parts, used_parts(reader, run, options));
  }
  if (parts.empty()) {
    const std::span<const double> t_s = reader.table().column("t_s");
    const auto [first, last] = std::ranges::minmax(t_s);
    reader.header_fault(ErrorCode::kTooFewData,
                        fmt::format("no row is left: t_s goes from {} to {} s; correct {}, "
                                    "{} or {}",
                                    first, last, option_text("from"), option_text("until"),
                                    option_text("exclude")));
  }
  runs = std::move(parts);
}

void check_length(TrialReader& reader, RowSpan run) {
  const std::size_t rows = run.end - run.begin;
  if (rows >= kShortestLog) return;
  const bool whole = rows == reader.table().rows();
  reader.header_fault(
      ErrorCode::kTooFewData,
      whole ? fmt::format("this log has {} rows; at least {} are needed", rows, kShortestLog)
            : fmt::format("the run from line {} has {} rows; at least {} are needed",
                          reader.table().line(std::min(run.begin, reader.table().rows() - 1)), rows,
                          kShortestLog));
}

void check_time(TrialReader& reader, RowSpan run) {
  const std::span<const double> t_s = reader.table().column("t_s");
  for (std::size_t i = run.begin + 1; i < run.end; ++i) {
    if (t_s[i] > t_s[i - 1]) continue;
    reader.fault(
        ErrorCode::kWrongOrder, i, "t_s",
        fmt::format("found {} after {}: time must increase{}", t_s[i], t_s[i - 1],
                    t_s[i] == t_s[i - 1] ? "; delete repeated rows, join rows of several topics "
                                           "into one, or write the time with more digits (counted "
                                           "from the start of the log)"
                    : reader.has("run")  ? ""
                                         : "; several runs in one file need a column run"));
  }
}

/// Adds the columns x (east) and y (north), m, from latitude and longitude: the position in the
/// local tangent plane at the first row of `rows`. Adds a fault for each latitude or longitude out
/// of range.
void add_geographic(TrialReader& reader, RowSpan rows, std::vector<ChannelColumn>& columns) {
  const std::vector<double> latitude = values_of(reader, rows, "latitude_deg", 1.0);
  const std::vector<double> longitude = values_of(reader, rows, "longitude_deg", 1.0);
  for (std::size_t i = 0; i < latitude.size(); ++i) {
    if (std::abs(latitude[i]) > 90.0) {
      reader.fault(ErrorCode::kOutOfRange, rows.begin + i, "latitude_deg",
                   fmt::format("found {}, outside [-90, 90]", latitude[i]));
    }
    if (std::abs(longitude[i]) > 360.0) {
      reader.fault(ErrorCode::kOutOfRange, rows.begin + i, "longitude_deg",
                   fmt::format("found {}, outside [-360, 360]", longitude[i]));
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
  const std::vector<std::size_t> present = rows_present(reader, rows, "latitude_deg");
  columns.push_back({LogChannel::kX, std::move(east), present});
  columns.push_back({LogChannel::kY, std::move(north), present});
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
  if (!joined) return median_step_of(t_s);
  std::vector<double> steps = steps_of(t_s);
  // The rows of two signals with about the same rate come in close pairs. The short steps within
  // the pairs hardly change this median, because each step is weighted with its length.
  std::sort(steps.begin(), steps.end());
  double left_s = 0.5 * (t_s.back() - t_s.front());
  for (const double step_s : steps) {
    left_s -= step_s;
    if (left_s <= 0.0) return step_s;
  }
  return steps.back();
}

bool has_force_difference(const DrivingLog& log) {
  constexpr double kMuch = 0.01;  // smallest difference of F' that counts: 1 % of F_max
  for (std::size_t i = 0; i < log.rows(); ++i) {
    if (std::abs(log.force_right[i] - log.force_left[i]) > kMuch) return true;
  }
  return false;
}

bool has_steering_changes(const DrivingLog& log) {
  constexpr double kLittle_rad = 1e-3;
  const auto [least, most] = std::ranges::minmax(log.driving_steering_rad());
  return most - least > kLittle_rad;
}

const std::vector<double>& DrivingLog::driving_steering_rad() const {
  return steering_command_rad ? *steering_command_rad : (*this)[LogChannel::kSteering]->value;
}

namespace {

bool is_joined(const CsvTable& table) {
  for (const CsvColumn& column : columns_of(TrialKind::kLog)) {
    if (table.has(column.name) && !table.present(column.name).empty()) return true;
  }
  return false;
}

/// Returns a log of one run that has only its times and commands.
DrivingLog commands_of(TrialReader& reader, RowSpan rows) {
  const CsvTable& table = reader.table();
  DrivingLog log;
  log.file = finding_file(table);
  log.mapped = table.mapped;
  log.joined = is_joined(table);
  log.line.reserve(rows.end - rows.begin);
  for (std::size_t row = rows.begin; row < rows.end; ++row) log.line.push_back(table.line(row));
  log.t_s = values_of(reader, rows, "t_s", 1.0);
  log.force_left = values_of(reader, rows, "force_left", 1.0);
  log.force_right = values_of(reader, rows, "force_right", 1.0);
  if (reader.has("steering_cmd_deg")) {
    log.steering_command_rad =
        values_of(reader, rows, "steering_cmd_deg", info(LogChannel::kSteering).to_si);
  } else if (!reader.has("steering_deg")) {
    // A vehicle without steering has the command 0.
    log.steering_command_rad.emplace(log.t_s.size(), 0.0);
  }
  return log;
}

/// Returns the constant_channels(), which are not measurements, and adds a finding for each.
std::vector<LogChannel> find_unmeasured(const TrialReader& reader, std::vector<Finding>& findings) {
  const CsvTable& table = reader.table();
  const auto values = [&](std::string_view column) -> std::optional<std::span<const double>> {
    return table.has(column) ? std::optional(table.column(column)) : std::nullopt;
  };
  std::vector<LogChannel> unmeasured;
  for (const ConstantChannel& one : constant_channels(values)) {
    const std::string_view column = info(one.channel).column;
    const bool is_turn = one.channel == LogChannel::kHeading || one.channel == LogChannel::kYawRate;
    findings.push_back(
        {finding_file(table), 0, Severity::kWarning, "constant-channel",
         fmt::format("{} is {:g} in every row while other channels move: it is not a measurement "
                     "(an unused field or a set-point) and is not used{}",
                     column, one.value, is_turn ? "; to identify yaw, record turns" : "")});
    unmeasured.push_back(one.channel);
  }
  return unmeasured;
}

/// Speed of each row, m/s: the last measured speed. Rows before the first measurement have the
/// first measured speed. Empty if the log has no speed.
std::vector<double> last_speeds(const TrialReader& reader, RowSpan rows) {
  if (!reader.has("speed_mps")) return {};
  const std::vector<std::size_t> present = rows_present(reader, rows, "speed_mps");
  if (present.empty()) return {};
  const std::span<const double> cells = reader.table().column("speed_mps").subspan(rows.begin);
  std::vector<double> speeds(rows.end - rows.begin, cells[present.front()]);
  for (std::size_t i = 0; i < present.size(); ++i) {
    const std::size_t end = i + 1 < present.size() ? present[i + 1] : speeds.size();
    std::fill(speeds.begin() + static_cast<std::ptrdiff_t>(present[i]),
              speeds.begin() + static_cast<std::ptrdiff_t>(end), cells[present[i]]);
  }
  return speeds;
}

/// Returns the columns of the measured channels, without `unmeasured`. Adds faults as
/// add_geographic().
std::vector<ChannelColumn> columns_in(TrialReader& reader, RowSpan rows, DrivingLog& log,
                                      std::span<const LogChannel> unmeasured,
                                      std::vector<Finding>& findings) {
  std::vector<ChannelColumn> columns;
  log.is_geographic = reader.has("latitude_deg");
  if (log.is_geographic) add_geographic(reader, rows, columns);
  const std::vector<double> speed_mps = last_speeds(reader, rows);
  for (const LogChannel channel : kChannels) {
    const ChannelInfo& about = info(channel);
    if (!reader.has(about.column) || std::ranges::count(unmeasured, channel) > 0) continue;
    ChannelColumn column{channel, values_of(reader, rows, about.column, about.to_si),
                         rows_present(reader, rows, about.column)};
    if (!log.joined) column.rounding = smallest_step(column.value);
    if (channel == LogChannel::kHeading) {
      if (!speed_mps.empty()) {
        set_aside_course_at_rest(log, speed_mps, column.value, column.present, findings);
      }
      unwrap(column.value);
    }
    columns.push_back(std::move(column));
  }
  return columns;
}

DrivingLog log_of(TrialReader& reader, RowSpan rows, std::span<const LogChannel> unmeasured,
                  std::vector<Finding>& findings) {
  DrivingLog log = commands_of(reader, rows);
  // The times of a joined log are unequal anyway, so their spacing does not show rounding.
  const bool is_joined_file = log.joined;
  if (!is_joined_file) replace_rounded_times(log.t_s, log.file, log.line.front(), findings);
  std::vector<ChannelColumn> columns = columns_in(reader, rows, log, unmeasured, findings);
  if (!reader.faults().empty()) return log;
  recover_original_rows(log, columns, findings);
  for (ChannelColumn& one : columns) {
    log[one.channel] = measured_of(one.channel, log, one.present, std::move(one.value), findings);
  }
  join_position(log);
  note_held(log, findings);
  for (const char* column : {"force_left", "force_right", "steering_cmd_deg"}) {
    if (is_joined_file && reader.has(column)) {
      note_stale_command(column, log, rows_present(reader, rows, column), findings);
    }
  }
  note_gaps(log, findings);
  if (reader.faults().empty()) add_row_of_rest(log);
  return log;
}

}  // namespace

Result<std::vector<DrivingLog>> read_logs(const std::filesystem::path& path,
                                          const TrialOptions& options,
                                          std::vector<Finding>& findings) {
  AWMR_ASSIGN_OR_RETURN(CsvTable table, read_table(path, columns_of(TrialKind::kLog), options));
  TrialReader reader(std::move(table), options);
  check_log_columns(reader, options.has_steering);
  std::vector<RowSpan> runs = runs_of(reader);
  for (RowSpan& run : runs) run = from_known_steering(reader, run);
  for (const RowSpan run : runs) check_time(reader, run);
  keep_used(reader, options, runs);
  for (const RowSpan run : runs) check_length(reader, run);
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));

  note_format(reader, findings);
  std::vector<DrivingLog> logs;
  logs.reserve(runs.size());
  const std::vector<LogChannel> unmeasured = find_unmeasured(reader, findings);
  for (const RowSpan run : runs) logs.push_back(log_of(reader, run, unmeasured, findings));
  if (!reader.faults().empty()) return input_errors(std::move(reader.faults()));
  return logs;
}

Result<DrivingLog> read_log(const std::filesystem::path& path, const TrialOptions& options,
                            std::vector<Finding>& findings) {
  AWMR_ASSIGN_OR_RETURN(std::vector<DrivingLog> logs, read_logs(path, options, findings));
  if (logs.size() == 1) return std::move(logs.front());
  return input_error(ErrorCode::kWrongFile, path.string(),
                     fmt::format("this file has {} runs; give a file with one run", logs.size()));
}

}  // namespace awmr
