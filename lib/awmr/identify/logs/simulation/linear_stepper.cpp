#include "awmr/identify/logs/simulation/linear_stepper.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

struct RateOfParameter {
  ParameterId id;
  double DrivenSlopes::*rate;
};

/// For each parameter, the rates of the state that depend directly on it.
constexpr RateOfParameter kActs[] = {
    {ParameterId::kSurgeAlpha, &DrivenSlopes::u},
    {ParameterId::kSurgeBeta, &DrivenSlopes::u},
    {ParameterId::kSurgeCoulomb, &DrivenSlopes::u},
    {ParameterId::kSurgeQuadratic, &DrivenSlopes::u},
    {ParameterId::kYawAlpha, &DrivenSlopes::r},
    {ParameterId::kYawBeta, &DrivenSlopes::r},
    {ParameterId::kYawCoulomb, &DrivenSlopes::r},
    {ParameterId::kYawQuadratic, &DrivenSlopes::r},
    {ParameterId::kSwayAlpha, &DrivenSlopes::v},
    {ParameterId::kMassNorm, &DrivenSlopes::u},
    {ParameterId::kMassNorm, &DrivenSlopes::v},
    {ParameterId::kMassNorm, &DrivenSlopes::r},
    {ParameterId::kInertiaNorm, &DrivenSlopes::r},
    {ParameterId::kSteeringTimeConstant, &DrivenSlopes::steering},
    {ParameterId::kWheelDeadZone, &DrivenSlopes::u},
    {ParameterId::kWheelDeadZone, &DrivenSlopes::v},
    {ParameterId::kWheelDeadZone, &DrivenSlopes::r},
    {ParameterId::kBackEmf, &DrivenSlopes::u},
    {ParameterId::kBackEmf, &DrivenSlopes::v},
    {ParameterId::kBackEmf, &DrivenSlopes::r},
};

constexpr double DrivenSlopes::*kDriven[kDrivenSize] = {&DrivenSlopes::u, &DrivenSlopes::v,
                                                        &DrivenSlopes::r, &DrivenSlopes::steering};

/// Time derivative of one column of S, the derivatives of the state with respect to the columns of
/// the fit: S_dot = A S + B. `b`, `s`: pointers to the first number of the column in B and S.
std::array<double, kStateSize> rate_of_column(const StateSlopes& a, const double* b,
                                              std::size_t columns, const double* s) {
  const double psi = s[2 * columns];
  const double u = s[3 * columns];
  const double v = s[4 * columns];
  const double r = s[5 * columns];
  const double steering = s[6 * columns];
  return {a.x_psi * psi + a.x_u * u + a.x_v * v,
          a.y_psi * psi + a.y_u * u + a.y_v * v,
          r,
          a.u_psi * psi + a.u_u * u + a.u_v * v + a.u_r * r + a.u_steering * steering + b[0],
          a.v_psi * psi + a.v_u * u + a.v_v * v + a.v_r * r + a.v_steering * steering + b[columns],
          a.r_u * u + a.r_v * v + a.r_r * r + a.r_steering * steering + b[2 * columns],
          a.steering_steering * steering + b[3 * columns]};
}

}  // namespace

LinearStepper::LinearStepper(const Plant<double>& plant, std::size_t columns,
                             const std::vector<ParameterColumn>& parameters,
                             const CommandTerms& terms, double longest_step_s,
                             const ExtraForces& extra)
    : plant_(
          plant,
          std::ranges::any_of(
              parameters, [](const ParameterColumn& p) { return p.id == ParameterId::kBackEmf; }),
          longest_step_s, extra),
      columns_(columns),
      command_terms_(terms),
      driven_(kStages * kDrivenSize * columns, 0.0) {
  if (columns == 0) return;
  for (const ParameterColumn& p : parameters) {
    for (const RateOfParameter& acts : kActs) {
      if (acts.id != p.id) continue;
      const auto rate = std::find(std::begin(kDriven), std::end(kDriven), acts.rate);
      const std::size_t place = at(rate - std::begin(kDriven)) * columns + p.column;
      const bool adds = std::ranges::find(terms_, place, &Term::place) != terms_.end();
      terms_.push_back({at(p.id), acts.rate, place, p.factor, adds});
    }
  }
}

void LinearStepper::note_driven(const DelayedCommand& command, double* driven) const {
  for (const Term& t : terms_) {
    const double before = t.adds ? driven[t.place] : 0.0;
    driven[t.place] = before + rates_.by_parameter[t.parameter].*t.rate * t.factor;
  }
  for (const ExtraColumn& extra : plant_.extra.columns) {
    const DrivenSlopes& by = rates_.by_extra[at(extra.force)];
    for (std::size_t i = 0; i < kDrivenSize; ++i) {
      driven[i * columns_ + extra.column] = by.*kDriven[i] * extra.factor;
    }
  }
  for_each_column(command_terms_, command, [&](std::size_t column, const HeldCommand& by) {
    set_column(by, column, driven);
  });
  if (command.change_column) {
    set_column(command.by[Kind::kDelay], *command.change_column, driven);
  }
  if (const auto& rate = command_terms_[Kind::kServoRate]) {
    driven[(kDrivenSize - 1) * columns_ + rate->column] = rates_.steering_by_max_rate;
  }
}

void LinearStepper::follow_change(const DelayedCommand& command) {
  if (command.change_column == change_column_) return;
  for (std::size_t i = 0; change_column_ && i < kStages * kDrivenSize; ++i) {
    driven_[i * columns_ + *change_column_] = 0.0;
  }
  change_column_ = command.change_column;
}

void LinearStepper::set_column(const HeldCommand& by, std::size_t column, double* driven) const {
  for (std::size_t i = 0; i < kDrivenSize; ++i) {
    const auto rate = kDriven[i];
    driven[i * columns_ + column] =
        by.force.left * rates_.by_force_left.*rate + by.force.right * rates_.by_force_right.*rate;
  }
  driven[(kDrivenSize - 1) * columns_ + column] = by.steering_rad * rates_.steering_by_command;
}

void LinearStepper::find_rates(const DelayedCommand& command, const State<double>& s) {
  linear_rates(plant_, s, command.command, rates_);
  if (plant_.friction.any()) add_friction(plant_, way_, rates_);
}

void LinearStepper::find_way(const DelayedCommand& command, LinearMotion& motion) {
  if (!plant_.friction.any()) return;
  const State<double>& s = motion.state;
  if (s.u_mps == 0.0 || s.r_radps == 0.0) linear_rates(plant_, s, command.command, rates_);
  FrictionRates<double> friction = plant_.friction;
  if (s.u_mps < 0.0 || (s.u_mps == 0.0 && rates_.rates.u_mps < 0.0)) {
    friction.surge_mps2 *= 1.0 + plant_.extra[ExtraForce::kBackwardDrag];
  }
  way_ = sliding(friction, s, rates_.rates);
  if (is_held(way_.surge, plant_.friction.surge_mps2)) {
    std::fill_n(motion.row(LogChannel::kSpeed, columns_), columns_, 0.0);
  }
  if (is_held(way_.yaw, plant_.friction.yaw_radps2)) {
    std::fill_n(motion.row(LogChannel::kYawRate, columns_), columns_, 0.0);
  }
}

State<double> LinearStepper::state_after(const DelayedCommand& command, double h,
                                         const State<double>& from) {
  // Coefficients of the classical Runge-Kutta method, as in rk4_step(). kToNext: distance of the
  // next stage, in steps. kShare: reciprocal weight of a stage in the result.
  constexpr double kToNext[kStages] = {0.5, 0.5, 1.0, 0.0};
  constexpr double kShare[kStages] = {6.0, 3.0, 3.0, 6.0};
  State<double> at_stage = from;
  State<double> next = from;
  for (std::size_t i = 0; i < kStages; ++i) {
    find_rates(command, at_stage);
    next = moved(next, rates_.rates, h / kShare[i]);
    at_stage = moved(from, rates_.rates, kToNext[i] * h);
    if (columns_ == 0) continue;
    slopes_[i] = rates_.by_state;
    note_driven(command, driven_.data() + i * kDrivenSize * columns_);
  }
  return next;
}

void LinearStepper::move_to(const State<double>& next, double h, LinearMotion& motion) {
  motion.state = next;
  if (columns_ > 0) {
    step_sensitivities(slopes_, driven_.data(), h, columns_, motion.by_column.data());
  }
}

void LinearStepper::stop(LogChannel speed, const DelayedCommand& command, LinearMotion& motion) {
  // S is the derivative of the speed w with respect to a column. A change of w by S before the stop
  // shifts the time of the stop by -S/w_dot. The speed after the stop changes by minus this shift
  // times the rate after the stop, so S after = S before (w_dot after)/(w_dot before).
  find_rates(command, motion.state);
  const double before = channel_of(rates_.rates, speed);
  channel_of(motion.state, speed) = 0.0;
  find_way(command, motion);
  find_rates(command, motion.state);
  const double factor = before != 0.0 ? channel_of(rates_.rates, speed) / before : 0.0;
  double* const row = motion.row(speed, columns_);
  for (std::size_t c = 0; c < columns_; ++c) row[c] *= factor;
}

void LinearStepper::step(const DelayedCommand& command, double h, LinearMotion& motion) {
  if (columns_ > 0) follow_change(command);
  for (int stops = 0;; ++stops) {
    find_way(command, motion);
    const State<double>& from = motion.state;
    const State<double> next = state_after(command, h, from);
    const double surge = share_until_rest(way_.surge, from.u_mps, next.u_mps);
    const double yaw = share_until_rest(way_.yaw, from.r_radps, next.r_radps);
    const double share = std::min(surge, yaw);
    if (share == 1.0 || stops == kMaxStopsInAStep) return move_to(next, h, motion);
    move_to(state_after(command, share * h, from), share * h, motion);
    stop(surge <= yaw ? LogChannel::kSpeed : LogChannel::kYawRate, command, motion);
    h *= 1.0 - share;
  }
}

State<double> LinearStepper::step_along_tangent(const DelayedCommand& command, double h,
                                                LinearMotion& motion) {
  if (columns_ > 0) follow_change(command);
  find_way(command, motion);
  find_rates(command, motion.state);
  motion.state = moved(motion.state, rates_.rates, h);
  if (columns_ > 0) note_driven(command, driven_.data());
  for (std::size_t c = 0; c < columns_; ++c) {
    double* const s = motion.by_column.data() + c;
    const auto rate = rate_of_column(rates_.by_state, driven_.data() + c, columns_, s);
    for (std::size_t i = 0; i < kStateSize; ++i) s[i * columns_] += h * rate[i];
  }
  return rates_.rates;
}

void LinearStepper::change_command(const DelayedCommand& before, const DelayedCommand& after,
                                   LinearMotion& motion) {
  if (columns_ == 0) return;
  const auto& delay = command_terms_[Kind::kDelay];
  const auto& steering_delay = command_terms_[Kind::kSteeringDelay];
  const State<double> old = rates(before, motion);
  const State<double> now = rates(after, motion);
  for (const LogChannel channel : kChannels) {
    const double less = channel_of(old, channel) - channel_of(now, channel);
    double* const row = motion.row(channel, columns_);
    if (delay) row[delay->column] += less;
    if (steering_delay && channel == LogChannel::kSteering) row[steering_delay->column] += less;
  }
  const RampImpulses impulses =
      ramp_impulses(before.command.force, after.command.force, command_terms_.turns_slowly);
  if (const auto& rise = command_terms_[Kind::kForceRise]) {
    add_impulse(rise->column, impulses.by_rise, motion);
  }
  if (const auto& fall = command_terms_[Kind::kForceFall]) {
    add_impulse(fall->column, impulses.by_fall, motion);
  }
}

void LinearStepper::add_impulse(std::size_t column, const SideForces<double>& area,
                                LinearMotion& motion) {
  for (const auto& [channel, rate] : {std::pair(LogChannel::kSpeed, &DrivenSlopes::u),
                                      std::pair(LogChannel::kSway, &DrivenSlopes::v),
                                      std::pair(LogChannel::kYawRate, &DrivenSlopes::r)}) {
    motion.row(channel, columns_)[column] +=
        area.left * rates_.by_force_left.*rate + area.right * rates_.by_force_right.*rate;
  }
}

void LinearStepper::change_time(std::size_t column, const DelayedCommand& before,
                                const DelayedCommand& after, LinearMotion& motion) {
  const State<double> old = rates(before, motion);
  const State<double> now = rates(after, motion);
  for (const LogChannel channel : kChannels) {
    motion.row(channel, columns_)[column] += channel_of(old, channel) - channel_of(now, channel);
  }
}

State<double> LinearStepper::rates(const DelayedCommand& command, LinearMotion& motion) {
  find_way(command, motion);
  find_rates(command, motion.state);
  return rates_.rates;
}

}  // namespace awmr
