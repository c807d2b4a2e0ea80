#include "awmr/identify/logs/linear_replay.h"

#include <algorithm>

#include "awmr/core/index.h"
#include "awmr/identify/logs/quantities.h"

namespace awmr {
namespace {

struct RateOfParameter {
  ParameterId id;
  double DrivenSlopes::*rate;
};

/// The rates that depend directly on each parameter.
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

/// Row of a component of State in LinearMotion::by_column.
std::size_t place_of(LogChannel channel) {
  switch (channel) {
    case LogChannel::kX:
      return 0;
    case LogChannel::kY:
      return 1;
    case LogChannel::kHeading:
      return 2;
    case LogChannel::kSpeed:
      return 3;
    case LogChannel::kSway:
      return 4;
    case LogChannel::kYawRate:
      return 5;
    case LogChannel::kSteering:
      break;
  }
  return 6;
}

/// Time derivative A S + B of one column of the derivatives S of the state. `b` and `s`: first
/// number of this column in B and S.
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

CommandColumns columns_of(const CommandPath& path) {
  const auto column = [](const auto& term) {
    return term ? std::optional(term->column) : std::nullopt;
  };
  return {
      column(path.delay),         column(path.steering_delay),     path.lag_column,
      column(path.steering_trim), column(path.steering_dead_band), column(path.steering_asymmetry),
      column(path.servo_rate),    column(path.imbalance),          column(path.exponent),
      column(path.saturation),    column(path.sharpness)};
}

const double* LinearMotion::row(LogChannel channel, std::size_t columns) const {
  return by_column.data() + place_of(channel) * columns;
}
double* LinearMotion::row(LogChannel channel, std::size_t columns) {
  return by_column.data() + place_of(channel) * columns;
}

LinearStepper::LinearStepper(const Plant<double>& plant, std::size_t columns,
                             const std::vector<ParameterColumn>& parameters,
                             const CommandColumns& command_columns, double longest_step_s,
                             const ExtraForces& extra)
    : plant_(
          plant,
          std::ranges::any_of(
              parameters, [](const ParameterColumn& p) { return p.id == ParameterId::kBackEmf; }),
          longest_step_s, extra),
      columns_(columns),
      command_columns_(command_columns),
      driven_(kStages * kDrivenSize * columns, 0.0) {
  if (columns == 0) return;
  for (const ParameterColumn& p : parameters) {
    for (const RateOfParameter& acts : kActs) {
      if (acts.id != p.id) continue;
      const auto rate = std::find(std::begin(kDriven), std::end(kDriven), acts.rate);
      const std::size_t place = at(rate - std::begin(kDriven)) * columns + p.column;
      terms_.push_back({at(p.id), acts.rate, place, p.factor});
    }
  }
}

void LinearStepper::note_driven(const DelayedCommand& command, double* driven) const {
  for (const Term& t : terms_) {
    driven[t.place] = rates_.by_parameter[t.parameter].*t.rate * t.factor;
  }
  for (const ExtraColumn& extra : plant_.extra.columns) {
    const DrivenSlopes& by = rates_.by_extra[at(extra.force)];
    for (std::size_t i = 0; i < kDrivenSize; ++i) {
      driven[i * columns_ + extra.column] = by.*kDriven[i] * extra.factor;
    }
  }
  const CommandColumns& c = command_columns_;
  for_each_force_column(c, command, [&](std::size_t column, const SideForces<double>& by) {
    set_column({by, 0.0}, column, driven);
  });
  if (c.steering_trim) set_column({{}, command.steering_by_trim}, *c.steering_trim, driven);
  if (c.steering_dead_band) {
    set_column({{}, command.steering_by_dead_band}, *c.steering_dead_band, driven);
  }
  if (c.steering_asymmetry) {
    set_column({{}, command.steering_by_asymmetry}, *c.steering_asymmetry, driven);
  }
  if (c.servo_rate) {
    driven[(kDrivenSize - 1) * columns_ + *c.servo_rate] = rates_.steering_by_max_rate;
  }
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
  // Coefficients of the classical Runge-Kutta method, as in rk4_step(). kShare: reciprocal weights.
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
  // A change S of the speed w before the stop shifts the time of the stop by -S/w_dot. The speed
  // after the stop changes by that time shift times the difference of the rates, so
  // S after = S before (w_dot after)/(w_dot before).
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
  const CommandColumns& c = command_columns_;
  if (columns_ == 0) return;
  const State<double> old = rates(before, motion);
  const State<double> now = rates(after, motion);
  for (const LogChannel channel : kChannels) {
    const double less = channel_of(old, channel) - channel_of(now, channel);
    double* const row = motion.row(channel, columns_);
    if (c.delay) row[*c.delay] += less;
    if (c.steering_delay && channel == LogChannel::kSteering) row[*c.steering_delay] += less;
  }
}

State<double> LinearStepper::rates(const DelayedCommand& command, LinearMotion& motion) {
  find_way(command, motion);
  find_rates(command, motion.state);
  return rates_.rates;
}

namespace {

/// Sets force and derivatives to 0 on each side whose command is 0 (CommandPath::switches_off).
void switch_off(const SideForces<double>& command, DelayedCommand& at_wheels) {
  const auto off = [&](double SideForces<double>::*side) {
    if (command.*side != 0.0) return;
    at_wheels.command.force.*side = 0.0;
    at_wheels.by_lag.*side = at_wheels.by_delay.*side = 0.0;
  };
  off(&SideForces<double>::left);
  off(&SideForces<double>::right);
}

}  // namespace

namespace {

/// Rows of the log whose commands act at one time. They differ if the steering has its own delay.
struct ActingRows {
  std::size_t forces;
  std::size_t steering;
};

HeldCommand logged_command(const DrivingLog& log, const ActingRows& rows) {
  return {{log.force_left[rows.forces], log.force_right[rows.forces]},
          log.driving_steering_rad()[rows.steering]};
}

/// Applies the saturation to the forces f and their derivatives. With w = (|f|/F'm)^n and
/// s = (1 - L)^(-n) - 1:
///
///     f_s = f (1 + s w)^(-1/n)
///     d f_s/d f = (1 + s w)^(-1/n - 1),   d f_s/d s = -f w/n d f_s/d f
///     d f_s/d L = d f_s/d s n (1 + s)/(1 - L)
///     d f_s/d ln n = f_s (ln(1 + s w) - s w ln(w)/(1 + s w))/n - d f_s/d s n (1 + s) ln(1 - L)
void saturate(const CommandPath& path, DelayedCommand& at) {
  const double rest = 1.0 - path.saturation->value;  // 1 - L
  const double n = path.sharpness ? path.sharpness->value : kDefaultSharpness;
  const double s = std::pow(rest, -n) - 1.0;
  for (double SideForces<double>::*const side :
       {&SideForces<double>::left, &SideForces<double>::right}) {
    double& force = at.command.force.*side;
    const double w = std::pow(std::abs(force) / path.full_command, n);
    const double sum = 1.0 + s * w;
    const double share = std::pow(sum, -1.0 / n);
    const double slope = share / sum;
    const double log_w = w > 0.0 ? std::log(w) : 0.0;
    const double by_s = -force * w * slope / n;
    at.by_saturation.*side = by_s * n * (1.0 + s) / rest;
    at.by_sharpness.*side = force * share * (std::log(sum) - s * w * log_w / sum) / n -
                            by_s * n * (1.0 + s) * std::log(rest);
    at.by_delay.*side *= slope;
    at.by_lag.*side *= slope;
    at.by_imbalance.*side *= slope;
    at.by_exponent.*side *= slope;
    force *= share;
  }
}

/// Replaces the forces f by |f|^p sgn f, with the derivatives
///
///     d/df = p |f|^(p - 1),   d/d ln p = p ln|f| |f|^p sgn f
void raise_to_power(const CommandPath& path, DelayedCommand& at) {
  const double p = path.exponent->value;
  for (double SideForces<double>::*const side :
       {&SideForces<double>::left, &SideForces<double>::right}) {
    double& force = at.command.force.*side;
    if (force == 0.0) continue;
    const double share = std::pow(std::abs(force), p - 1.0);
    at.by_exponent.*side = p * std::log(std::abs(force)) * force * share;
    at.by_delay.*side *= p * share;
    at.by_lag.*side *= p * share;
    at.by_imbalance.*side *= p * share;
    force *= share;
  }
}

/// Applies dead band and asymmetry of the linkage to the steering command.
void steer_by_linkage(const CommandPath& path, DelayedCommand& at) {
  const double band_rad = path.steering_dead_band ? path.steering_dead_band->value : 0.0;
  const double e = path.steering_asymmetry ? path.steering_asymmetry->value : 0.0;
  double& angle_rad = at.command.steering_rad;
  const bool moves = std::abs(angle_rad) > band_rad;
  const double side = std::copysign(moves ? 1.0 : 0.0, angle_rad);
  const double beyond_rad = moves ? angle_rad - side * band_rad : 0.0;
  const double share = 1.0 + side * e;
  at.steering_by_dead_band = -side * share;
  at.steering_by_asymmetry = std::abs(beyond_rad);
  angle_rad = beyond_rad * share;
}

DelayedCommand with_errors(DelayedCommand at, const CommandPath& path) {
  if (path.steering_dead_band || path.steering_asymmetry) steer_by_linkage(path, at);
  if (path.steering_trim) {
    at.command.steering_rad += path.steering_trim->value;
    at.steering_by_trim = 1.0;
  }
  if (path.imbalance) {
    at.by_imbalance = {-at.command.force.left, at.command.force.right};
    for (SideForces<double>* const force : {&at.command.force, &at.by_delay, &at.by_lag}) {
      force->left *= 1.0 - path.imbalance->value;
      force->right *= 1.0 + path.imbalance->value;
    }
  }
  if (path.exponent) raise_to_power(path, at);
  if (path.saturation) saturate(path, at);
  return at;
}

double force_delay_s(const CommandPath& path) { return path.delay ? path.delay->delay_s : 0.0; }
double steering_delay_s(const CommandPath& path) {
  return force_delay_s(path) + (path.steering_delay ? path.steering_delay->delay_s : 0.0);
}

/// The command that reaches the wheels over [t, t + h], while the commands of `rows` act. If the
/// motors have a lag, the forces are means over this time.
DelayedCommand command_over(const LogSignals& signals, const ActingRows& rows, double t_s,
                            double h_s, const CommandPath& path) {
  DelayedCommand at{logged_command(*signals.log, rows)};
  if (!path.lag) return with_errors(at, path);
  const SideForces<double> command = at.command.force;
  const LaggedForces::Mean mean = path.lag->mean(signals, t_s, h_s, force_delay_s(path));
  at.command.force = mean.force;
  at.by_lag = mean.by_lag;
  at.by_delay = mean.by_delay;
  if (path.switches_off) switch_off(command, at);
  return with_errors(at, path);
}

}  // namespace

DelayedCommand command_at(const LogSignals& signals, double t_s, const CommandPath& path) {
  constexpr double kMoment_s = 1e-6;
  const auto row_at = [&](double at_s) {  // a change exactly at this time counts
    return ActingRow(signals.log->t_s, at_s + 2.0 * kSameTime_s).row();
  };
  return command_over(signals,
                      {row_at(t_s - force_delay_s(path)), row_at(t_s - steering_delay_s(path))},
                      t_s, kMoment_s, path);
}

namespace {

/// Adds the derivatives by the delays at a time at which the acting rows change from `before` to
/// `after`. Forces of motors with lag are left out, because they do not jump.
void change_rows(const LogSignals& signals, ActingRows before, const ActingRows& after,
                 const CommandPath& path, LinearStepper& stepper, LinearMotion& motion) {
  if (path.lag) before.forces = after.forces;
  const DrivingLog& log = *signals.log;
  stepper.change_command(with_errors({logged_command(log, before)}, path),
                         with_errors({logged_command(log, after)}, path), motion);
}

}  // namespace

void steer(const LogSignals& signals, std::size_t row, double share, const CommandPath& path,
           std::size_t columns, LinearMotion& motion) {
  motion.state.steering_rad = signals.angle_after(row, share);
  if (path.steering_trim) motion.state.steering_rad += path.steering_trim->value;
  double* const by_column = motion.row(LogChannel::kSteering, columns);
  std::fill(by_column, by_column + columns, 0.0);
  if (path.steering_trim && columns > 0) by_column[path.steering_trim->column] = 1.0;
}

namespace {

/// Steps from `from_s` to `to_s`, between which the same rows act.
void step_along(const LogSignals& signals, std::size_t row, const ActingRows& rows, double from_s,
                double to_s, const CommandPath& path, LinearStepper& stepper, double longest_step_s,
                LinearMotion& motion) {
  const DrivingLog& log = *signals.log;
  const double row_s = log.t_s[row];
  const double span_s = row + 1 < log.rows() ? log.t_s[row + 1] - row_s : 1.0;
  const double share = (from_s - row_s) / span_s;
  const double end_share = (to_s - row_s) / span_s;
  const int steps = steps_in(to_s - from_s, longest_step_s);
  const double h = (to_s - from_s) / steps;
  for (int i = 0; i < steps; ++i) {
    DelayedCommand command = command_over(signals, rows, from_s + i * h, h, path);
    if (!log.steering_command_rad) {
      steer(signals, row, share + (end_share - share) * ((i + 0.5) / steps), path,
            stepper.columns(), motion);
      command.command.steering_rad = motion.state.steering_rad;
    }
    stepper.step(command, h, motion);
  }
}

}  // namespace

void advance_after_row(const LogSignals& signals, std::size_t row, double from_s, double to_s,
                       const CommandPath& path, LinearStepper& stepper, double longest_step_s,
                       LinearMotion& motion) {
  if (!path.delay && !path.steering_delay) {
    return step_along(signals, row, {row, row}, from_s, to_s, path, stepper, longest_step_s,
                      motion);
  }
  const DrivingLog& log = *signals.log;
  const double of_forces_s = force_delay_s(path);
  const double of_steering_s = steering_delay_s(path);
  ActingRow forces(log.t_s, from_s - of_forces_s);
  ActingRow steering(log.t_s, from_s - of_steering_s);
  for (;;) {
    const auto force_change_s = forces.next_change_s(
        to_s - of_forces_s, [&](auto a, auto b) { return signals.forces_differ(a, b); });
    const auto steering_change_s = steering.next_change_s(
        to_s - of_steering_s,
        [&](auto a, auto b) { return signals.steering_commands_differ(a, b); });
    const ActingRows rows{forces.row(), steering.row()};
    const double forces_s = force_change_s ? *force_change_s + of_forces_s : to_s;
    const double steering_s = steering_change_s ? *steering_change_s + of_steering_s : to_s;
    const double until_s = std::min(forces_s, steering_s);
    const bool is_last = !force_change_s && !steering_change_s;
    if (is_last || until_s - from_s > kSameTime_s) {
      step_along(signals, row, rows, from_s, until_s, path, stepper, longest_step_s, motion);
      from_s = until_s;
    }
    if (is_last) return;
    if (force_change_s && forces_s - until_s < kSameTime_s) forces.pass_change();
    if (steering_change_s && steering_s - until_s < kSameTime_s) steering.pass_change();
    change_rows(signals, rows, {forces.row(), steering.row()}, path, stepper, motion);
  }
}

LinearMotion earlier_motion(const LogSignals& signals, std::size_t begin,
                            const std::vector<LinearMotion>& motions, LinearStepper& stepper,
                            const DelayColumn& delay, double longest_step_s,
                            const CommandPath& path) {
  const DrivingLog& log = *signals.log;
  const double now_s = log.t_s[begin + motions.size() - 1];
  const double then_s = now_s - delay.delay_s;
  std::size_t row = begin + motions.size() - 1;
  while (row > begin && log.t_s[row] > then_s) --row;
  LinearMotion motion = motions[row - begin];
  const double row_s = log.t_s[row];
  if (then_s > row_s) {
    advance_after_row(signals, row, row_s, then_s, path, stepper, longest_step_s, motion);
  }
  DelayedCommand command = command_at(signals, std::max(row_s, then_s), path);
  if (!log.steering_command_rad) command.command.steering_rad = motion.state.steering_rad;
  const State<double> rates = then_s < row_s
                                  ? stepper.step_along_tangent(command, then_s - row_s, motion)
                                  : stepper.rates(command, motion);
  // A longer delay selects an earlier time.
  if (stepper.columns() == 0) return motion;
  for (const LogChannel channel : kChannels) {
    motion.row(channel, stepper.columns())[delay.column] -= channel_of(rates, channel);
  }
  return motion;
}

}  // namespace awmr
