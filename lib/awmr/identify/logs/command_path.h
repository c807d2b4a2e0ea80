/// Path of the logged commands to the wheels: delays, motor lag and constant errors. A log fit
/// needs the derivatives of the commands at the wheels with respect to the free quantities. A
/// "column" is the index of a free quantity among these derivatives. Private to identify/.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "awmr/identify/logs/linear_rates.h"
#include "awmr/identify/logs/ramped_forces.h"
#include "awmr/identify/logs/uncertain_changes.h"
#include "awmr/trials/lagged_forces.h"

namespace awmr {

/// A delay or a time constant (s), and its column: its index among the unknowns of the fit
/// (linear_stepper.h).
struct DelayColumn {
  double delay_s;
  std::size_t column;
};

/// A constant error of the commands (for example trim in rad, imbalance or saturation), and its
/// column among the unknowns of the fit.
struct OffsetColumn {
  double value;
  std::size_t column;
};

/// Delays, lag and constant errors between the logged commands and the wheels.
struct CommandPath {
  /// Delay of all commands; < 0: their time stamps are late.
  std::optional<DelayColumn> delay = {};
  /// Delay of the steering alone, in addition to `delay`.
  std::optional<DelayColumn> steering_delay = {};
  std::optional<LaggedForces> lag = {};  ///< forces after the motors' lag
  /// Column of the motors' time constant; absent if it is fixed.
  std::optional<std::size_t> lag_column = {};
  /// Times, s, in which the controller lets the force of a motor rise or fall by F_max.
  std::optional<OffsetColumn> rise = {};
  std::optional<OffsetColumn> fall = {};
  bool turns_slowly = false;  ///< RampTimes::turns_slowly
  /// Forces after these ramps and the lag, instead of `lag`. Absent without `rise` and `fall`, and
  /// if the forces jump because both times are 0 (with a delay, but without a lag).
  std::optional<RampedForces> ramps = {};
  /// Trim, rad: added to the steering command or logged angle.
  std::optional<OffsetColumn> steering_trim = {};
  /// Dead band, rad, asymmetry e, curve k and scale error q of the steering linkage
  /// (FreeQuantity::Kind). Absent for logs with measured steering angles.
  std::optional<OffsetColumn> steering_dead_band = {};
  std::optional<OffsetColumn> steering_asymmetry = {};
  std::optional<OffsetColumn> steering_curve = {};
  std::optional<OffsetColumn> steering_scale = {};
  double steering_stop_rad = 1.0;  ///< d_max of the vehicle file, > 0
  /// True: the stop limits the command, before the errors of the linkage act. False: the plant
  /// limits the angle.
  bool stop_limits_command = false;
  /// Steering rate limit, rad/s, instead of the vehicle file's.
  std::optional<OffsetColumn> servo_rate = {};
  /// Imbalance e: left forces times 1 - e, right times 1 + e.
  std::optional<OffsetColumn> imbalance = {};
  std::optional<OffsetColumn> exponent = {};    ///< exponent p of the forces; column of ln p
  std::optional<OffsetColumn> saturation = {};  ///< share L of lost force
  double full_command = 1.0;                    ///< largest command F'm of the logs
  std::optional<OffsetColumn> sharpness = {};   ///< its sharpness n; column of ln n
  /// True for motors with back-EMF: a motor whose command is 0 gives no force, although the lag of
  /// earlier commands would still give one.
  bool switches_off = false;

  /// Changes of the commands at uncertain times, in the order of their rows. The column of the time
  /// of changes[i] is `first_change_column` + i.
  std::span<const UncertainChange> changes = {};
  std::size_t first_change_column = 0;

  /// Column of the time at which the commands of `row` begin to act. Empty if this time is known.
  std::optional<std::size_t> change_column(std::size_t row) const;
  /// Column of the last of the changes up to `row`; empty if there is none.
  std::optional<std::size_t> last_change_column(std::size_t row) const;

  /// True if a jump of a logged command gives no jump of the force that the integration has to
  /// treat: the mean force over each step includes it.
  bool has_mean_forces() const { return lag || ramps; }
  double force_delay_s() const { return delay ? delay->delay_s : 0.0; }
  double steering_delay_s() const {
    return force_delay_s() + (steering_delay ? steering_delay->delay_s : 0.0);
  }
};

struct CommandColumns {
  std::optional<std::size_t> delay = {};
  std::optional<std::size_t> steering_delay = {};
  std::optional<std::size_t> lag = {};
  std::optional<std::size_t> rise = {};
  std::optional<std::size_t> fall = {};
  std::optional<std::size_t> steering_trim = {};
  std::optional<std::size_t> steering_dead_band = {};
  std::optional<std::size_t> steering_asymmetry = {};
  std::optional<std::size_t> steering_curve = {};
  std::optional<std::size_t> steering_scale = {};
  std::optional<std::size_t> servo_rate = {};
  std::optional<std::size_t> imbalance = {};
  std::optional<std::size_t> exponent = {};
  std::optional<std::size_t> saturation = {};
  std::optional<std::size_t> sharpness = {};
  bool turns_slowly = false;  ///< CommandPath::turns_slowly
};
CommandColumns columns_of(const CommandPath& path);

/// Commands as they reach the wheels, and their derivatives with respect to the delays, lags and
/// errors of CommandPath that the fit estimates.
struct DelayedCommand {
  HeldCommand command;
  /// d force / d delay, 1/s. Set only for motors with lag or ramps. Without, the force jumps; then
  /// LinearStepper::change_command() adds the derivative with respect to the delay.
  SideForces<double> by_delay{};
  SideForces<double> by_lag{};         ///< d force / d time constant of the motors, 1/s
  SideForces<double> by_rise{};        ///< d force / d rise time, 1/s
  SideForces<double> by_fall{};        ///< d force / d fall time, 1/s
  SideForces<double> by_imbalance{};   ///< d force / d imbalance
  SideForces<double> by_exponent{};    ///< d force / d ln p
  SideForces<double> by_saturation{};  ///< d force / d L
  SideForces<double> by_sharpness{};   ///< d force / d ln n
  /// Column of the latest change of the forces, if its time is uncertain. Set only for motors with
  /// lag. The derivative of the force with respect to this time is `by_delay`, because the effect
  /// of earlier changes is assumed to have decayed.
  std::optional<std::size_t> change_column = {};
  double steering_by_trim = 0.0;       ///< d steering / d trim: 1 with a trim in the path, else 0
  double steering_by_dead_band = 0.0;  ///< d steering / d dead band
  double steering_by_asymmetry = 0.0;  ///< d steering / d asymmetry, rad
  double steering_by_curve = 0.0;      ///< d steering / d curve, rad
  double steering_by_scale = 0.0;      ///< d steering / d scale error, rad
};

/// Calls visit(column, by) for each free quantity that changes the forces of `command`. `by`:
/// derivative of the forces with respect to this quantity.
template <class Visit>
void for_each_force_column(const CommandColumns& c, const DelayedCommand& command, Visit visit) {
  if (c.delay) visit(*c.delay, command.by_delay);
  if (c.lag) visit(*c.lag, command.by_lag);
  if (c.rise) visit(*c.rise, command.by_rise);
  if (c.fall) visit(*c.fall, command.by_fall);
  if (c.imbalance) visit(*c.imbalance, command.by_imbalance);
  if (c.exponent) visit(*c.exponent, command.by_exponent);
  if (c.saturation) visit(*c.saturation, command.by_saturation);
  if (c.sharpness) visit(*c.sharpness, command.by_sharpness);
}

/// Rows of the log whose commands act at a time: one for the forces, one for the steering command.
/// They differ if the steering has its own delay.
struct ActingRows {
  std::size_t forces;
  std::size_t steering;
};

/// Returns the logged commands of the given rows with the constant errors of the path, but without
/// its delay and lag.
DelayedCommand command_of_rows(const DrivingLog& log, const ActingRows& rows,
                               const CommandPath& path);

/// Returns the command that reaches the wheels in the interval [t, t + h]. `rows`: rows of the log
/// whose commands act in this interval. With a motor lag, the forces are means over the interval.
DelayedCommand command_over(const LogSignals& signals, const ActingRows& rows, double t_s,
                            double h_s, const CommandPath& path);

/// Returns the command that reaches the wheels at the time t. If the command changes exactly at t,
/// this is the new command.
DelayedCommand command_at(const LogSignals& signals, double t_s, const CommandPath& path);

}  // namespace awmr
