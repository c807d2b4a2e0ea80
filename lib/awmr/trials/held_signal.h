/// The commands of a log as functions of time. A command is held: it stays constant until the next
/// row.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "awmr/model/dynamics.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Integral over time of a command that is constant between rows.
class HeldSignal {
 public:
  HeldSignal(const std::vector<double>& t_s, const std::vector<double>& value);
  /// Integral from the time of the log's first row to t_s. Before the first row the command has its
  /// first value, after the last row its last value.
  double integral(double t_s) const;

 private:
  const std::vector<double>* t_s_;
  const std::vector<double>* value_;
  std::vector<double> integral_;
};

/// The commands of a log.
struct LogSignals {
  explicit LogSignals(const DrivingLog& log);
  const DrivingLog* log;
  HeldSignal left;   ///< force_left
  HeldSignal right;  ///< force_right

  /// The logged steering angle, rad, interpolated between `row` and the next row. `share`: fraction
  /// of the time between these rows that has passed, 0 to 1. Precondition: the log has steering
  /// angles.
  double angle_after(std::size_t row, double share) const {
    const std::vector<double>& angle = (*log)[LogChannel::kSteering]->value;
    return angle[row] + share * (angle[std::min(row + 1, angle.size() - 1)] - angle[row]);
  }
  bool forces_differ(std::size_t row, std::size_t other) const {
    return log->force_left[row] != log->force_left[other] ||
           log->force_right[row] != log->force_right[other];
  }
  /// True if two rows have different steering commands; false if the log has only steering angles.
  bool steering_commands_differ(std::size_t row, std::size_t other) const {
    const auto& command = log->steering_command_rad;
    return command && (*command)[row] != (*command)[other];
  }
};

/// Times that differ by less than this, s, count as equal.
inline constexpr double kSameTime_s = 1e-9;

/// Steps through the rows of a log from one change of the commands to the next.
class ActingRow {
 public:
  /// Begins at the last row before the time `t_s`. So next_change_s() finds later changes of the
  /// commands, and a change exactly at `t_s`.
  ActingRow(const std::vector<double>& row_times_s, double t_s)
      : t_s_(&row_times_s),
        row_(static_cast<std::size_t>(std::ranges::lower_bound(row_times_s, t_s - kSameTime_s) -
                                      row_times_s.begin())) {
    if (row_ > 0) --row_;
  }
  /// The row whose commands are applied.
  std::size_t row() const { return row_; }
  /// Time of the next change before `to_s`; empty if there is none. `differ(row, next)`: true if
  /// the commands of two rows differ.
  template <class Differ>
  std::optional<double> next_change_s(double to_s, Differ differ) {
    while (row_ + 1 < t_s_->size() && (*t_s_)[row_ + 1] < to_s - kSameTime_s) {
      if (differ(row_, row_ + 1)) return (*t_s_)[row_ + 1];
      ++row_;
    }
    return std::nullopt;
  }
  /// Moves to the row of the change that next_change_s() returned.
  void pass_change() { ++row_; }

 private:
  const std::vector<double>* t_s_;
  std::size_t row_;
};

/// Mean over [t, t + h] of a command that takes effect `delay_s` after it was logged.
inline double delayed_mean(const HeldSignal& signal, double t_s, double h_s, double delay_s) {
  return (signal.integral(t_s + h_s - delay_s) - signal.integral(t_s - delay_s)) / h_s;
}

}  // namespace awmr
