#include "awmr/identify/logs/simulation/ramped_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "awmr/trials/lagged_forces.h"

namespace awmr {
namespace {

using Knot = RampedForces::Knot;
using WithDerivatives = RampedForces::WithDerivatives;

/// Area of the impulse at a jump by `gap`, see RampedForces.
double impulse_at(double gap) { return -0.5 * gap * std::abs(gap); }

/// First part of the way from a force to another one: the fall of its magnitude, to 0 if the sign
/// changes. 0 if the magnitude rises.
double fall_between(double before, double after) {
  if (before * after < 0.0) return -before;
  return std::abs(after) < std::abs(before) ? after - before : 0.0;
}

/// Columns of WithDerivatives.
constexpr Eigen::Index kByRise = 1;
constexpr Eigen::Index kByFall = 2;

/// c, its integral and F' at the time `t_s` in the piece of c that begins at `knot`.
Knot moved_to(const Knot& knot, double t_s, double lag_s) {
  const double dt = t_s - knot.t_s;
  const WithDerivatives command = knot.command + dt * knot.slope;
  Knot now{t_s,     command, knot.slope, knot.integral + 0.5 * dt * (knot.command + command),
           command, 0.0};
  if (!(lag_s > 0.0)) return now;
  const double e = std::exp(-dt / lag_s);
  const WithDerivatives behind = knot.force - knot.command + lag_s * knot.slope;
  now.force += e * behind - lag_s * knot.slope;
  now.by_lag =
      (knot.by_lag + knot.slope(0)) * e - knot.slope(0) + behind(0) * e * dt / (lag_s * lag_s);
  return now;
}

/// Builds the pieces of the ramped command of one side, row after row.
class RampBuilder {
 public:
  RampBuilder(const RampTimes& times, double first_s, double command) : times_(times) {
    now_(0) = command;
    knots_.push_back({first_s, now_, WithDerivatives::Zero(), WithDerivatives::Zero(), now_, 0.0});
  }

  /// Follows the logged command m from `from_s` to `until_s`.
  void follow(double command, double from_s, double until_s) {
    const Knot& last = knots_.back();
    if (now_(0) == command && last.slope(0) == 0.0 && last.command(0) == command) return;
    start_.setZero();
    start_(0) = from_s;
    impulse_.setZero();
    const bool turns = now_(0) * command < 0.0;
    const bool is_slow = turns && times_.turns_slowly;
    const bool falls = turns || std::abs(command) < std::abs(now_(0));
    if (falls && !ramp(turns ? 0.0 : command, is_slow ? times_.rise_s : times_.fall_s,
                       is_slow ? kByRise : kByFall, until_s)) {
      return;
    }
    if (now_(0) != command && !ramp(command, times_.rise_s, kByRise, until_s)) return;
    add(WithDerivatives::Zero());
  }

  std::vector<Knot> take() { return std::move(knots_); }

 private:
  /// Ramps from c to `to` in `time_s` times the distance, beginning at start_. Returns false if c
  /// does not reach `to` before `until_s`. `column`: column of the derivative with respect to
  /// `time_s`.
  bool ramp(double to, double time_s, Eigen::Index column, double until_s) {
    const double gap = to - now_(0);
    const double sign = std::copysign(1.0, gap);
    if (time_s > 0.0) {
      WithDerivatives slope = WithDerivatives::Zero();
      slope(0) = sign / time_s;
      slope(column) = -sign / (time_s * time_s);
      const WithDerivatives at_start = now_;
      now_.tail<2>() -= slope(0) * start_.tail<2>();
      add(slope);
      const double end_s = start_(0) + std::abs(gap) * time_s;
      if (end_s >= until_s) {
        now_ += (until_s - start_(0)) * slope;
        return false;
      }
      start_.tail<2>() -= sign * time_s * at_start.tail<2>();
      start_(0) = end_s;
      start_(column) += std::abs(gap);
    } else {
      impulse_.tail<2>() -= gap * start_.tail<2>();
      impulse_(column) += impulse_at(gap);
      start_(column) += std::abs(gap);
    }
    now_.setZero();
    now_(0) = to;
    return true;
  }

  /// Adds a piece with this slope, which begins at start_ with the command now_.
  void add(const WithDerivatives& slope) {
    Knot knot = moved_to(knots_.back(), start_(0), times_.lag_s);
    knot.command = now_;
    knot.slope = slope;
    knot.integral += impulse_;
    if (times_.lag_s > 0.0) knot.force += impulse_ / times_.lag_s;
    if (!(times_.lag_s > 0.0)) knot.force = now_;
    knots_.push_back(knot);
    impulse_.setZero();
  }

  RampTimes times_;
  std::vector<Knot> knots_;
  WithDerivatives now_ = WithDerivatives::Zero();      ///< c at start_
  WithDerivatives start_ = WithDerivatives::Zero();    ///< time of the next piece, s
  WithDerivatives impulse_ = WithDerivatives::Zero();  ///< impulses in the derivatives of c there
};

std::vector<Knot> ramped(const DrivingLog& log, const std::vector<double>& command,
                         std::size_t begin, std::size_t end, const RampTimes& times) {
  RampBuilder builder(times, log.t_s[begin], command[begin]);
  for (std::size_t row = begin; row < end; ++row) {
    const double until_s =
        row + 1 < end ? log.t_s[row + 1] : std::numeric_limits<double>::infinity();
    builder.follow(command[row], log.t_s[row], until_s);
  }
  return builder.take();
}

/// c, its integral and F' at the time `t_s`; at a jump, the values before it. Times that differ by
/// rounding count as equal.
Knot value_at(const std::vector<Knot>& knots, double t_s, double lag_s) {
  constexpr double kRounding_s = 1e-9;
  const auto after = std::ranges::lower_bound(knots, t_s - kRounding_s, {}, &Knot::t_s);
  if (after != knots.begin()) return moved_to(*std::prev(after), t_s, lag_s);
  Knot before = knots.front();
  before.slope.setZero();
  before.integral = (t_s - before.t_s) * before.command;
  return before;
}

}  // namespace

RampImpulses ramp_impulses(const SideForces<double>& before, const SideForces<double>& after,
                           bool turns_slowly) {
  RampImpulses impulses;
  for (double SideForces<double>::*const side :
       {&SideForces<double>::left, &SideForces<double>::right}) {
    const double fall = fall_between(before.*side, after.*side);
    const double rise = after.*side - before.*side - fall;
    const double of_fall = impulse_at(fall) - rise * std::abs(fall);  // the rise begins later
    const bool is_slow = turns_slowly && rise != 0.0;
    impulses.by_fall.*side = is_slow ? 0.0 : of_fall;
    impulses.by_rise.*side = impulse_at(rise) + (is_slow ? of_fall : 0.0);
  }
  return impulses;
}

RampedForces::RampedForces(const DrivingLog& log, std::size_t begin, std::size_t end,
                           const RampTimes& times)
    : times_(times) {
  constexpr double kRamps = 2.0;  // from -F_max to F_max
  const double memory_s = kForgottenLags * times.lag_s + kRamps * (times.rise_s + times.fall_s);
  const RowSpan rows = rows_with_effect(log, {begin, end}, memory_s);
  left_ = ramped(log, log.force_left, rows.begin, rows.end, times);
  right_ = ramped(log, log.force_right, rows.begin, rows.end, times);
}

void RampedForces::add_mean(const std::vector<Knot>& knots, double from_s, double h_s,
                            double SideForces<double>::*side, Mean& mean) const {
  const Knot from = value_at(knots, from_s, times_.lag_s);
  const Knot to = value_at(knots, from_s + h_s, times_.lag_s);
  const WithDerivatives rate = (to.force - from.force) / h_s;
  const WithDerivatives force = (to.integral - from.integral) / h_s - times_.lag_s * rate;
  mean.force.*side = force(0);
  mean.by_rise.*side = force(kByRise);
  mean.by_fall.*side = force(kByFall);
  mean.by_delay.*side = -rate(0);
  mean.by_lag.*side = -rate(0) - times_.lag_s * (to.by_lag - from.by_lag) / h_s;
}

RampedForces::Mean RampedForces::mean(double t_s, double h_s, double delay_s) const {
  Mean result;
  add_mean(left_, t_s - delay_s, h_s, &SideForces<double>::left, result);
  add_mean(right_, t_s - delay_s, h_s, &SideForces<double>::right, result);
  return result;
}

}  // namespace awmr
