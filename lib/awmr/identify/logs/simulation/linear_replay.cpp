#include "awmr/identify/logs/simulation/linear_replay.h"

#include <algorithm>
#include <tuple>

#include "awmr/trials/replay.h"

namespace awmr {
namespace {

using Kind = FreeQuantity::Kind;

/// Updates the derivatives of the motion with respect to the time of a command change, if this time
/// is uncertain. `before`: rows of the log whose commands acted until the change; `after`: rows of
/// the new commands. Forces of motors with lag or ramps are left out, because the mean
/// forces include their changes (DelayedCommand::change_column).
void change_time_of_rows(const LogSignals& signals, ActingRows before, const ActingRows& after,
                         const CommandPath& path, LinearStepper& stepper, LinearMotion& motion) {
  if (stepper.columns() == 0 || path.changes.empty()) return;
  const bool is_of_forces = before.forces != after.forces;
  const auto column = path.change_column(is_of_forces ? after.forces : after.steering);
  if (!column) return;
  if (path.has_mean_forces()) before.forces = after.forces;
  const DrivingLog& log = *signals.log;
  stepper.change_time(*column, command_of_rows(log, before, path),
                      command_of_rows(log, after, path), motion);
}

/// Updates the derivatives of the motion at a command change: those with respect to the time of the
/// change, as change_time_of_rows() does, and those with respect to the delays of the commands.
/// Forces of motors with lag or ramps are left out, as there. `before`, `after`: as in
/// change_time_of_rows().
void change_rows(const LogSignals& signals, ActingRows before, const ActingRows& after,
                 const CommandPath& path, LinearStepper& stepper, LinearMotion& motion) {
  change_time_of_rows(signals, before, after, path, stepper, motion);
  if (path.has_mean_forces()) before.forces = after.forces;
  const DrivingLog& log = *signals.log;
  stepper.change_command(command_of_rows(log, before, path), command_of_rows(log, after, path),
                         motion);
}

/// Integrates from `from_s` to `to_s`, an interval in which no command changes.
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

/// Changes of x_dot and y_dot by changes of u, v and psi. `by_state`: derivatives of the rates of
/// the pose (add_kinematics()).
double x_dot_by(const StateSlopes& by_state, double u, double v, double heading) {
  return by_state.x_u * u + by_state.x_v * v + by_state.x_psi * heading;
}
double y_dot_by(const StateSlopes& by_state, double u, double v, double heading) {
  return by_state.y_u * u + by_state.y_v * v + by_state.y_psi * heading;
}

/// Adds `factor` times the derivatives of the pose rates at the motion `of` to those of the pose.
void add_by_column(const LinearMotion& of, const StateSlopes& by_state, double factor,
                   std::size_t columns, LinearMotion& to) {
  for (std::size_t c = 0; c < columns; ++c) {
    const double u = of.row(LogChannel::kSpeed, columns)[c];
    const double v = of.row(LogChannel::kSway, columns)[c];
    const double heading = of.row(LogChannel::kHeading, columns)[c];
    to.row(LogChannel::kX, columns)[c] += factor * x_dot_by(by_state, u, v, heading);
    to.row(LogChannel::kY, columns)[c] += factor * y_dot_by(by_state, u, v, heading);
    to.row(LogChannel::kHeading, columns)[c] += factor * of.row(LogChannel::kYawRate, columns)[c];
  }
}

/// Extrapolates the motion by h_s < 0 seconds: speeds along the tangent, the pose with the mean of
/// its rates at both ends (Heun). Returns the derivative of the result with respect to h_s.
State<double> extrapolate(const DelayedCommand& command, double h_s, LinearStepper& stepper,
                          LinearMotion& motion) {
  const LinearMotion start = motion;
  State<double> by_time = stepper.step_along_tangent(command, h_s, motion);
  const LinearMotion end = motion;
  LinearRates before{};
  LinearRates after{};
  add_kinematics(start.state, before);
  add_kinematics(end.state, after);
  motion.state.x_m += 0.5 * h_s * (after.rates.x_m - before.rates.x_m);
  motion.state.y_m += 0.5 * h_s * (after.rates.y_m - before.rates.y_m);
  motion.state.psi_rad += 0.5 * h_s * (after.rates.psi_rad - before.rates.psi_rad);
  add_by_column(start, before.by_state, -0.5 * h_s, stepper.columns(), motion);
  add_by_column(end, after.by_state, 0.5 * h_s, stepper.columns(), motion);
  const auto [u, v, heading] = std::tuple(by_time.u_mps, by_time.v_mps, by_time.psi_rad);
  by_time.x_m =
      0.5 * (before.rates.x_m + after.rates.x_m + h_s * x_dot_by(after.by_state, u, v, heading));
  by_time.y_m =
      0.5 * (before.rates.y_m + after.rates.y_m + h_s * y_dot_by(after.by_state, u, v, heading));
  by_time.psi_rad = 0.5 * (before.rates.psi_rad + after.rates.psi_rad + h_s * by_time.r_radps);
  return by_time;
}

}  // namespace

void steer(const LogSignals& signals, std::size_t row, double share, const CommandPath& path,
           std::size_t columns, LinearMotion& motion) {
  const auto& trim = path.terms[Kind::kSteeringTrim];
  motion.state.steering_rad = signals.angle_after(row, share) + (trim ? trim->value : 0.0);
  double* const by_column = motion.row(LogChannel::kSteering, columns);
  std::fill(by_column, by_column + columns, 0.0);
  if (trim && columns > 0) by_column[trim->column] = 1.0;
}

void advance_after_row(const LogSignals& signals, std::size_t row, double from_s, double to_s,
                       const CommandPath& path, LinearStepper& stepper, double longest_step_s,
                       LinearMotion& motion) {
  const CommandTerms& terms = path.terms;
  if (!terms[Kind::kDelay] && !terms[Kind::kSteeringDelay]) {
    if (row > 0 && from_s == signals.log->t_s[row]) {
      change_time_of_rows(signals, {row - 1, row - 1}, {row, row}, path, stepper, motion);
    }
    return step_along(signals, row, {row, row}, from_s, to_s, path, stepper, longest_step_s,
                      motion);
  }
  const DrivingLog& log = *signals.log;
  const double of_forces_s = path.force_delay_s();
  const double of_steering_s = path.steering_delay_s();
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
                            const TermColumn& delay, double longest_step_s,
                            const CommandPath& path) {
  const DrivingLog& log = *signals.log;
  const double now_s = log.t_s[begin + motions.size() - 1];
  const double then_s = now_s - delay.value;
  std::size_t row = begin + motions.size() - 1;
  while (row > begin && log.t_s[row] > then_s) --row;
  LinearMotion motion = motions[row - begin];
  const double row_s = log.t_s[row];
  if (then_s > row_s) {
    advance_after_row(signals, row, row_s, then_s, path, stepper, longest_step_s, motion);
  }
  // Before the first row of a part inside the log, the command of the row before acted.
  const bool is_before = then_s < row_s && row > 0 && !path.has_mean_forces();
  const double acting_s = is_before ? row_s - 4.0 * kSameTime_s : std::max(row_s, then_s);
  DelayedCommand command = command_at(signals, acting_s, path);
  if (!log.steering_command_rad) command.command.steering_rad = motion.state.steering_rad;
  const State<double> rates = then_s < row_s ? extrapolate(command, then_s - row_s, stepper, motion)
                                             : stepper.rates(command, motion);
  // A longer delay selects an earlier time, so the derivative of the motion with respect to the
  // delay is minus the rate.
  if (stepper.columns() == 0) return motion;
  for (const LogChannel channel : kChannels) {
    motion.row(channel, stepper.columns())[delay.column] -= channel_of(rates, channel);
  }
  return motion;
}

}  // namespace awmr
