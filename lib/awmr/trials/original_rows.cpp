#include "original_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "awmr/core/containers.h"
#include "interpolated_readings.h"

namespace awmr {
namespace {

/// A command of the log.
struct CommandColumn {
  const char* name;
  std::vector<double>* value;
  double rounding;                        ///< printed_resolution() of the column, SI
  std::optional<Readings> readings = {};  ///< its values at the times of a channel's readings
  bool is_interpolated = false;           ///< false: held between these times
};

/// Readings of the interpolated columns of a log. Columns of the same message share their times.
struct Recovered {
  std::vector<std::optional<Readings>> channels;  ///< in the order of the columns
  std::vector<CommandColumn> commands;
};

/// Returns the times that were recovered so far and between which the column is interpolated, or
/// the column's own readings.
std::optional<Readings> readings_of(const DrivingLog& log, const ChannelColumn& column,
                                    const std::vector<std::optional<Readings>>& others) {
  if (column.present.size() != log.rows()) return std::nullopt;
  for (const std::optional<Readings>& other : others) {
    if (!other) continue;
    if (auto same = interpolated_between(other->t_s, log.t_s, column.value, column.rounding)) {
      return same;
    }
  }
  return interpolated_readings(log.t_s, column.value, column.rounding);
}

Recovered recovered_of(DrivingLog& log, const std::vector<ChannelColumn>& columns) {
  Recovered recovered;
  for (const ChannelColumn& column : columns) {
    recovered.channels.push_back(readings_of(log, column, recovered.channels));
  }
  recovered.commands = {{"force_left", &log.force_left, printed_resolution(log.force_left)},
                        {"force_right", &log.force_right, printed_resolution(log.force_right)}};
  if (log.steering_command_rad) {
    const double to_si = info(LogChannel::kSteering).to_si;
    std::vector<double> printed = *log.steering_command_rad;
    for (double& angle : printed) angle /= to_si;
    recovered.commands.push_back(
        {"steering_cmd_deg", &*log.steering_command_rad, printed_resolution(printed) * to_si});
  }
  for (CommandColumn& command : recovered.commands) {
    for (const std::optional<Readings>& channel : recovered.channels) {
      if (!channel || command.readings) continue;
      command.readings =
          interpolated_between(channel->t_s, log.t_s, *command.value, command.rounding);
      command.is_interpolated = command.readings.has_value();
      if (!command.readings) {
        command.readings = changing_at(channel->t_s, log.t_s, *command.value);
      }
    }
  }
  return recovered;
}

/// Times of the new rows, s, ascending. Times closer than `same_s` are one row.
std::vector<double> times_of_rows(const DrivingLog& log, const std::vector<ChannelColumn>& columns,
                                  const Recovered& recovered, double same_s) {
  std::vector<bool> stays(log.rows(), false);
  stays.front() = true;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (recovered.channels[i]) continue;
    for (const std::size_t row : columns[i].present) stays[row] = true;
  }
  for (const CommandColumn& command : recovered.commands) {
    if (command.readings) continue;
    for (std::size_t row = 1; row < log.rows(); ++row) {
      if ((*command.value)[row] != (*command.value)[row - 1]) stays[row] = true;
    }
  }
  std::vector<double> all_s;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (stays[row]) all_s.push_back(log.t_s[row]);
  }
  for (const std::optional<Readings>& readings : recovered.channels) {
    if (readings) all_s.insert(all_s.end(), readings->t_s.begin(), readings->t_s.end());
  }
  std::sort(all_s.begin(), all_s.end());
  const auto is_same = [same_s](double a, double b) { return b - a < same_s; };
  all_s.erase(std::unique(all_s.begin(), all_s.end(), is_same), all_s.end());
  return all_s;
}

/// For each of the times `to_s`, the last of the times `from_s` that is at most `same_s` later (the
/// first one if there is none). Both ascend.
std::vector<std::size_t> last_before(const std::vector<double>& to_s,
                                     const std::vector<double>& from_s, double same_s) {
  std::vector<std::size_t> last;
  std::size_t at = 0;
  for (const double t : to_s) {
    while (at + 1 < from_s.size() && from_s[at + 1] < t + same_s) ++at;
    last.push_back(at);
  }
  return last;
}

/// Rows, in ascending order, at the times `t_s`: the rows whose `last` index is a new one.
std::vector<std::size_t> rows_of_each(const std::vector<std::size_t>& last) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < last.size(); ++row) {
    if (row == 0 || last[row] != last[row - 1]) rows.push_back(row);
  }
  return rows;
}

/// The note `interpolated-readings`.
Finding note_of(const DrivingLog& log, const std::vector<ChannelColumn>& columns,
                const Recovered& recovered) {
  std::vector<std::string> names;
  double rate_hz = 0.0;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::optional<Readings>& readings = recovered.channels[i];
    if (!readings) continue;
    names.emplace_back(info(columns[i].channel).column);
    const double duration_s = readings->t_s.back() - readings->t_s.front();
    rate_hz = static_cast<double>(readings->t_s.size() - 1) / duration_s;
  }
  for (const CommandColumn& command : recovered.commands) {
    if (command.is_interpolated) names.emplace_back(command.name);
  }
  return {log.file, 0, Severity::kNote, "interpolated-readings",
          fmt::format("the values of {} are on straight lines between readings at about {:.3g} Hz: "
                      "another program interpolated them. Nothing needs to be done: awmr has "
                      "recovered the readings and uses only these. It is better to give each "
                      "signal at its own times, with empty cells in between",
                      fmt::join(names, ", "), rate_hz)};
}

}  // namespace

void recover_original_rows(DrivingLog& log, std::vector<ChannelColumn>& columns,
                           std::vector<Finding>& findings) {
  if (log.joined) return;
  Recovered recovered = recovered_of(log, columns);
  if (std::ranges::none_of(recovered.channels, [](const auto& one) { return one.has_value(); })) {
    return;
  }
  findings.push_back(note_of(log, columns, recovered));
  const double same_s = 1e-3 * log.median_step_s();
  const std::vector<double> t_s = times_of_rows(log, columns, recovered, same_s);
  const std::vector<std::size_t> old_row = last_before(t_s, log.t_s, same_s);
  for (CommandColumn& command : recovered.commands) {
    const std::optional<Readings>& readings = command.readings;
    *command.value = readings ? picked(readings->value, last_before(t_s, readings->t_s, same_s))
                              : picked(*command.value, old_row);
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    ChannelColumn& column = columns[i];
    const std::optional<Readings>& readings = recovered.channels[i];
    const std::vector<std::size_t> last =
        readings ? last_before(t_s, readings->t_s, same_s) : old_row;
    column.value = picked(readings ? readings->value : column.value, last);
    if (readings) {
      column.present = rows_of_each(last);
    } else {
      const std::vector<double> present_s = picked(log.t_s, column.present);
      column.present = rows_of_each(last_before(t_s, present_s, same_s));
    }
  }
  log.line = picked(log.line, old_row);
  log.t_s = t_s;
  log.joined = std::ranges::any_of(
      columns, [&](const ChannelColumn& column) { return column.present.size() != t_s.size(); });
}

}  // namespace awmr
