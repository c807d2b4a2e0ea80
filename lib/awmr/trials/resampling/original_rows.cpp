#include "original_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "awmr/core/containers.h"
#include "even_times.h"
#include "interpolated_readings.h"

namespace awmr {
namespace {

/// A command of the log.
struct CommandColumn {
  const char* name;
  std::vector<double>* value;
  double to_si;                           ///< SI value = value in the file times `to_si`
  std::optional<Readings> readings = {};  ///< its values at the times of a channel's readings
  bool is_interpolated = false;           ///< false: held between these times
};

/// Readings of the interpolated channels of a log, in the order of its columns. Columns of the same
/// message share their times.
using ChannelReadings = std::vector<std::optional<Readings>>;

/// True if the column can be recovered: it has a value in every row. A steering angle without a
/// command is the input of the model, which is needed in every row.
bool is_recoverable(const DrivingLog& log, const ChannelColumn& column) {
  const bool is_input = column.channel == LogChannel::kSteering && !log.steering_command_rad;
  return column.present.size() == log.rows() && !is_input;
}

/// Readings of the column at the times of another column that was recovered.
std::optional<Readings> shared_readings(const DrivingLog& log, const ChannelColumn& column,
                                        const ChannelReadings& others) {
  for (const std::optional<Readings>& other : others) {
    if (!other) continue;
    if (auto same = interpolated_between(other->t_s, log.t_s, column.value, column.rounding)) {
      return same;
    }
  }
  return std::nullopt;
}

ChannelReadings recovered_channels(const DrivingLog& log,
                                   const std::vector<ChannelColumn>& columns) {
  ChannelReadings channels(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!is_recoverable(log, columns[i])) continue;
    channels[i] = shared_readings(log, columns[i], channels);
    if (channels[i]) continue;
    channels[i] = interpolated_readings(log.t_s, columns[i].value, columns[i].rounding);
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {  // later columns can help earlier ones
    if (channels[i] || !is_recoverable(log, columns[i])) continue;
    channels[i] = shared_readings(log, columns[i], channels);
  }
  return channels;
}

std::vector<CommandColumn> recovered_commands(DrivingLog& log, const ChannelReadings& channels) {
  std::vector<CommandColumn> commands{{"force_left", &log.force_left, 1.0},
                                      {"force_right", &log.force_right, 1.0}};
  if (log.steering_command_rad) {
    commands.push_back(
        {"steering_cmd_deg", &*log.steering_command_rad, info(LogChannel::kSteering).to_si});
  }
  for (CommandColumn& command : commands) {
    std::vector<double> in_file = *command.value;
    for (double& one : in_file) one /= command.to_si;
    const double rounding = printed_resolution(in_file) * command.to_si;
    for (const std::optional<Readings>& channel : channels) {
      if (!channel || command.readings) continue;
      command.readings = interpolated_between(channel->t_s, log.t_s, *command.value, rounding);
      command.is_interpolated = command.readings.has_value();
      if (!command.readings) {
        command.readings = changing_at(channel->t_s, log.t_s, *command.value);
      }
    }
  }
  return commands;
}

/// Times of the new rows, s, ascending. Times closer than `same_s` are one row.
std::vector<double> times_of_rows(const DrivingLog& log, const std::vector<ChannelColumn>& columns,
                                  const ChannelReadings& channels,
                                  const std::vector<CommandColumn>& commands, double same_s) {
  std::vector<bool> stays(log.rows(), false);
  stays.front() = true;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (channels[i]) continue;
    for (const std::size_t row : columns[i].present) stays[row] = true;
  }
  for (const CommandColumn& command : commands) {
    if (command.readings) continue;
    for (std::size_t row = 1; row < log.rows(); ++row) {
      if ((*command.value)[row] != (*command.value)[row - 1]) stays[row] = true;
    }
  }
  std::vector<double> all_s;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (stays[row]) all_s.push_back(log.t_s[row]);
  }
  for (const std::optional<Readings>& readings : channels) {
    if (readings) append(all_s, readings->t_s);
  }
  std::sort(all_s.begin(), all_s.end());
  const auto is_same = [same_s](double a, double b) { return b - a < same_s; };
  all_s.erase(std::unique(all_s.begin(), all_s.end(), is_same), all_s.end());
  return all_s;
}

/// For each of the times `to_s`, the number of times `from_s` that are at most `same_s` later. Both
/// ascend.
std::vector<std::size_t> counts_until(const std::vector<double>& to_s,
                                      const std::vector<double>& from_s, double same_s) {
  std::vector<std::size_t> counts;
  std::size_t count = 0;
  for (const double t : to_s) {
    while (count < from_s.size() && from_s[count] < t + same_s) ++count;
    counts.push_back(count);
  }
  return counts;
}

/// Values of a column in the new rows. `counts`: for each row, the number of readings up to it; a
/// row has the last of these readings. Rows before the first reading have the values `before`.
std::vector<double> held(const Readings& readings, const std::vector<std::size_t>& counts,
                         std::vector<double> before) {
  for (std::size_t row = 0; row < counts.size(); ++row) {
    if (counts[row] > 0) before[row] = readings.value[counts[row] - 1];
  }
  return before;
}

/// The rows, in ascending order, in which the number of readings increases.
std::vector<std::size_t> rows_with_readings(const std::vector<std::size_t>& counts) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < counts.size(); ++row) {
    if (counts[row] > (row == 0 ? 0 : counts[row - 1])) rows.push_back(row);
  }
  return rows;
}

/// The note `interpolated-readings`.
Finding note_of(const DrivingLog& log, const std::vector<ChannelColumn>& columns,
                const ChannelReadings& channels, const std::vector<CommandColumn>& commands) {
  std::vector<std::string> names;
  const auto add = [&](std::string_view name, const Readings& readings) {
    names.push_back(fmt::format("{} ({:.3g} Hz)", name, 1.0 / median_step_of(readings.t_s)));
  };
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (channels[i]) add(info(columns[i].channel).column, *channels[i]);
  }
  for (const CommandColumn& command : commands) {
    if (command.is_interpolated) add(command.name, *command.readings);
  }
  return {log.file, 0, Severity::kNote, "interpolated-readings",
          fmt::format("the values of these columns are on straight lines between slower readings: "
                      "{}. Another program interpolated them. Nothing needs to be done: awmr has "
                      "recovered the readings and uses only these. Next time, log each signal at "
                      "its own times, with empty cells in between",
                      fmt::join(names, ", "))};
}

}  // namespace

void recover_original_rows(DrivingLog& log, std::vector<ChannelColumn>& columns,
                           std::vector<Finding>& findings) {
  if (log.joined) return;
  const ChannelReadings channels = recovered_channels(log, columns);
  if (std::ranges::none_of(channels, [](const auto& one) { return one.has_value(); })) return;
  const std::vector<CommandColumn> commands = recovered_commands(log, channels);
  findings.push_back(note_of(log, columns, channels, commands));
  const double same_s = 1e-3 * log.median_step_s();
  const std::vector<double> t_s = times_of_rows(log, columns, channels, commands, same_s);
  std::vector<std::size_t> old_row = counts_until(t_s, log.t_s, same_s);
  for (std::size_t& row : old_row) row -= std::min<std::size_t>(row, 1);  // the last row until then
  for (const CommandColumn& command : commands) {
    std::vector<double> of_file = picked(*command.value, old_row);
    const std::optional<Readings>& readings = command.readings;
    *command.value =
        readings ? held(*readings, counts_until(t_s, readings->t_s, same_s), std::move(of_file))
                 : std::move(of_file);
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    ChannelColumn& column = columns[i];
    const std::optional<Readings>& readings = channels[i];
    const std::vector<std::size_t> counts =
        counts_until(t_s, readings ? readings->t_s : picked(log.t_s, column.present), same_s);
    std::vector<double> of_file = picked(column.value, old_row);
    column.value = readings ? held(*readings, counts, std::move(of_file)) : std::move(of_file);
    column.present = rows_with_readings(counts);
  }
  log.line = picked(log.line, old_row);
  log.t_s = t_s;
  log.joined = std::ranges::any_of(
      columns, [&](const ChannelColumn& column) { return column.present.size() != t_s.size(); });
}

}  // namespace awmr
