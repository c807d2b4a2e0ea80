#include "awmr/identify/logs/problem/uncertain_changes.h"

#include <Eigen/Cholesky>
#include <numbers>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/trials/held_signal.h"

namespace awmr {
namespace {

/// Standard deviation of a uniform distribution of width 1, 1/sqrt(12).
constexpr double kUniformStd = 0.5 * std::numbers::inv_sqrt3;

bool is_change(const LogSignals& signals, std::size_t row) {
  return signals.forces_differ(row, row - 1) || signals.steering_commands_differ(row, row - 1);
}

/// Row of the new log: the row `row` of the original log, or a row inserted before it for a change
/// of the commands.
struct PlannedRow {
  std::size_t row;
  bool is_inserted;  ///< true: half a row spacing before `row`
};

std::vector<PlannedRow> planned_rows(const DrivingLog& log) {
  const LogSignals signals(log);
  const double gap_s = kGapSteps * log.median_step_s();
  std::vector<PlannedRow> rows;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const bool inserts =
        row > 0 && is_change(signals, row) && log.t_s[row] - log.t_s[row - 1] <= gap_s;
    if (inserts) rows.push_back({row, true});
    rows.push_back({row, false});
  }
  return rows;
}

/// The signal at these rows: halfway to the previous row for an inserted row.
std::vector<double> at_rows(const std::vector<double>& signal,
                            const std::vector<PlannedRow>& rows) {
  std::vector<double> values;
  for (const auto& [row, is_inserted] : rows) {
    values.push_back(is_inserted ? 0.5 * (signal[row - 1] + signal[row]) : signal[row]);
  }
  return values;
}

/// A command at these rows: an inserted row has the new command.
std::vector<double> held_at_rows(const std::vector<double>& command,
                                 const std::vector<PlannedRow>& rows) {
  std::vector<double> values;
  for (const PlannedRow& planned : rows) values.push_back(command[planned.row]);
  return values;
}

DrivingLog with_inserted_rows(const DrivingLog& log) {
  const std::vector<PlannedRow> rows = planned_rows(log);
  DrivingLog fine = log;
  fine.t_s = at_rows(log.t_s, rows);
  fine.force_left = held_at_rows(log.force_left, rows);
  fine.force_right = held_at_rows(log.force_right, rows);
  if (log.steering_command_rad) {
    fine.steering_command_rad = held_at_rows(*log.steering_command_rad, rows);
  }
  fine.line.clear();
  fine.change_std_s.clear();
  for (const auto& [row, is_inserted] : rows) {
    if (!log.line.empty()) fine.line.push_back(log.line[row]);
    fine.change_std_s.push_back(is_inserted ? kUniformStd * (log.t_s[row] - log.t_s[row - 1])
                                            : 0.0);
  }
  for (auto& channel : fine.measured) {
    if (!channel) continue;
    const std::vector<bool> fresh = std::exchange(channel->fresh, {});
    channel->value = at_rows(channel->value, rows);
    for (const auto& [row, is_inserted] : rows) {
      channel->fresh.push_back(!is_inserted && fresh[row]);
    }
  }
  return fine;
}

}  // namespace

std::vector<UncertainChange> uncertain_changes(const LogWindow& window) {
  std::vector<UncertainChange> changes;
  const std::vector<double>& std_s = window.log->change_std_s;
  for (std::size_t row = window.begin + 1; row < window.end && !std_s.empty(); ++row) {
    if (std_s[row] > 0.0) changes.push_back({row, 0.0, std_s[row]});
  }
  return changes;
}

std::vector<UncertainChange> changes_before_rows(const LogWindow& window) {
  const LogSignals signals(*window.log);
  const std::vector<double>& t_s = window.log->t_s;
  std::vector<UncertainChange> changes;
  for (std::size_t row = window.begin + 1; row < window.end; ++row) {
    if (!is_change(signals, row)) continue;
    const double spacing_s = t_s[row] - t_s[row - 1];
    changes.push_back({row, -0.5 * spacing_s, kUniformStd * spacing_s});
  }
  const double most = kMaxChangeShare * static_cast<double>(window.end - window.begin);
  if (static_cast<double>(changes.size()) > most) changes.clear();
  return changes;
}

std::vector<DrivingLog> with_changes_between_rows(const std::vector<DrivingLog>& logs) {
  std::vector<DrivingLog> fine;
  for (const DrivingLog& log : logs) fine.push_back(with_inserted_rows(log));
  return fine;
}

Marginalised marginalised(const Eigen::MatrixXd& products,
                          const std::vector<UncertainChange>& changes) {
  const Eigen::Index m = rows_of(changes);
  const Eigen::Index n = products.rows() - 1 - m;
  Eigen::VectorXd std(m);
  Eigen::VectorXd mean(m);  // in standard deviations
  for (Eigen::Index i = 0; i < m; ++i) {
    std(i) = changes[at(i)].std_s;
    mean(i) = changes[at(i)].mean_s / std(i);
  }
  Eigen::MatrixXd h = std.asDiagonal() * products.block(n, n, m, m) * std.asDiagonal();
  h.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> factor(h);
  Eigen::MatrixXd mixed(m, n + 1);
  mixed.leftCols(n) = std.asDiagonal() * products.block(n, 0, m, n);
  mixed.col(n) = std.asDiagonal() * products.block(n, n + m, m, 1) - mean;
  const Eigen::MatrixXd solution = factor.solve(mixed);
  Marginalised result;
  result.products.resize(n + 1, n + 1);
  result.products.topLeftCorner(n, n) = products.topLeftCorner(n, n);
  result.products.topRightCorner(n, 1) = products.block(0, n + m, n, 1);
  result.products.bottomLeftCorner(1, n) = products.block(n + m, 0, 1, n);
  result.products(n, n) = products(n + m, n + m) + mean.squaredNorm();
  result.products -= mixed.transpose() * solution;
  result.ln_det = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  result.standardised = -solution.col(n) - mean;
  result.decrease = solution.leftCols(n);
  return result;
}

}  // namespace awmr
