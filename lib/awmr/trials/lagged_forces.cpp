#include "awmr/trials/lagged_forces.h"

#include <algorithm>
#include <cmath>

namespace awmr {
namespace {

/// Decay of the difference between motor force and command in a time h. T is the time constant of
/// the motor.
struct Decay {
  double left_over;  ///< remaining fraction of the difference, exp(-h/T)
  double by_lag;     ///< derivative of left_over with respect to T, 1/s
};
Decay decay(double h_s, double lag_s) {
  if (!(lag_s > 0.0)) return {0.0, 0.0};
  const double e = std::exp(-h_s / lag_s);
  return {e, e * h_s / (lag_s * lag_s)};
}

}  // namespace

RowSpan rows_with_effect(const DrivingLog& log, RowSpan rows, double memory_s) {
  constexpr double kLongestDelay_s = 1.0;  // positive or negative
  const double from_s = log.t_s[rows.begin] - memory_s - kLongestDelay_s;
  const double until_s = log.t_s[rows.end - 1] + kLongestDelay_s;
  while (rows.begin > 0 && log.t_s[rows.begin] > from_s) --rows.begin;
  while (rows.end < log.rows() && log.t_s[rows.end] < until_s) ++rows.end;
  return rows;
}

LaggedForces::LaggedForces(const DrivingLog& log, std::size_t begin, std::size_t end, double lag_s)
    : log_(&log), lag_s_(lag_s) {
  const RowSpan rows = rows_with_effect(log, {begin, end}, kForgottenLags * lag_s);
  first_row_ = rows.begin;
  left_ = side(log.force_left, rows.end);
  right_ = side(log.force_right, rows.end);
}

LaggedForces::Side LaggedForces::side(const std::vector<double>& command, std::size_t end) const {
  Side side;
  side.force.reserve(end - first_row_);
  side.by_lag.reserve(end - first_row_);
  double force = command[first_row_];
  double by_lag = 0.0;
  for (std::size_t row = first_row_; row < end; ++row) {
    side.force.push_back(force);
    side.by_lag.push_back(by_lag);
    if (row + 1 == end) break;
    const Decay e = decay(log_->t_s[row + 1] - log_->t_s[row], lag_s_);
    const double behind = force - command[row];
    force = command[row] + behind * e.left_over;
    by_lag = by_lag * e.left_over + behind * e.by_lag;
  }
  return side;
}

LaggedForces::Value LaggedForces::at(const Side& side, const std::vector<double>& command,
                                     double t_s) const {
  // The time at the end of an integration step can differ by rounding from the time of the row
  // there. Times that differ by less than this count as equal.
  constexpr double kRounding_s = 1e-9;
  const auto first = log_->t_s.begin() + static_cast<std::ptrdiff_t>(first_row_);
  const auto last = first + static_cast<std::ptrdiff_t>(side.force.size());
  const auto after = std::lower_bound(first, last, t_s - kRounding_s);
  if (after == first) return {command[first_row_], 0.0};
  const auto place = static_cast<std::size_t>(after - first) - 1;
  const std::size_t row = first_row_ + place;
  const Decay e = decay(t_s - log_->t_s[row], lag_s_);
  const double behind = side.force[place] - command[row];
  return {command[row] + behind * e.left_over,
          side.by_lag[place] * e.left_over + behind * e.by_lag};
}

LaggedForces::Mean LaggedForces::mean(const LogSignals& signals, double t_s, double h_s,
                                      double delay_s) const {
  const auto of = [&](const Side& side, const std::vector<double>& command,
                      const HeldSignal& signal, double& mean, double& by_lag, double& by_delay) {
    const Value from = at(side, command, t_s - delay_s);
    const Value to = at(side, command, t_s + h_s - delay_s);
    const double rate = (to.force - from.force) / h_s;
    mean = delayed_mean(signal, t_s, h_s, delay_s) - lag_s_ * rate;
    by_lag = -rate - lag_s_ * (to.by_lag - from.by_lag) / h_s;
    by_delay = -rate;
  };
  Mean m{};
  of(left_, log_->force_left, signals.left, m.force.left, m.by_lag.left, m.by_delay.left);
  of(right_, log_->force_right, signals.right, m.force.right, m.by_lag.right, m.by_delay.right);
  return m;
}

}  // namespace awmr
