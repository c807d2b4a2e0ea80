/// Path of the logged commands to the wheels: delays, motor lag and constant errors, with
/// derivatives with respect to the free quantities of a log fit. A "column" is the index of a free
/// quantity among these derivatives. Private to identify/.
#pragma once

#include <cstddef>
#include <optional>

#include "awmr/identify/logs/linear_rates.h"
#include "awmr/trials/lagged_forces.h"

namespace awmr {

/// A delay or a lag and the column of its derivatives.
struct DelayColumn {
  double delay_s;
  std::size_t column;
};

/// A constant error of the commands (trim in rad, imbalance or saturation) and the column of its
/// derivatives.
struct OffsetColumn {
  double value;
  std::size_t column;
};

/// Delays, lag and constant errors between the logged commands and the wheels.
struct CommandPath {
  std::optional<DelayColumn> delay = {};           ///< of all commands; < 0: late time stamps
  std::optional<DelayColumn> steering_delay = {};  ///< of the steering, in addition to `delay`
  std::optional<LaggedForces> lag = {};            ///< forces after the motors' lag
  std::optional<std::size_t> lag_column = {};      ///< column of the lag; present if it is free
  std::optional<OffsetColumn> steering_trim = {};  ///< rad, added to command or logged angle
  /// Dead band, rad, and asymmetry e of steering_asymmetry(); not for logs with measured angles.
  std::optional<OffsetColumn> steering_dead_band = {};
  std::optional<OffsetColumn> steering_asymmetry = {};
  std::optional<OffsetColumn> servo_rate = {};  ///< rate limit, rad/s, in place of the plant's
  std::optional<OffsetColumn> imbalance = {};   ///< e: left forces times 1 - e, right times 1 + e
  std::optional<OffsetColumn> exponent = {};    ///< p of force_exponent(); column of ln p
  std::optional<OffsetColumn> saturation = {};  ///< L of force_saturation()
  double full_command = 1.0;                    ///< F'm of force_saturation()
  std::optional<OffsetColumn> sharpness = {};   ///< n of force_saturation(); column of ln n
  /// True for motors with back-EMF: a motor is off as soon as its command is 0, regardless of its
  /// lag.
  bool switches_off = false;

  double force_delay_s() const { return delay ? delay->delay_s : 0.0; }
  double steering_delay_s() const {
    return force_delay_s() + (steering_delay ? steering_delay->delay_s : 0.0);
  }
};

/// Columns of the free quantities of a command path.
struct CommandColumns {
  std::optional<std::size_t> delay = {};
  std::optional<std::size_t> steering_delay = {};
  std::optional<std::size_t> lag = {};
  std::optional<std::size_t> steering_trim = {};
  std::optional<std::size_t> steering_dead_band = {};
  std::optional<std::size_t> steering_asymmetry = {};
  std::optional<std::size_t> servo_rate = {};
  std::optional<std::size_t> imbalance = {};
  std::optional<std::size_t> exponent = {};
  std::optional<std::size_t> saturation = {};
  std::optional<std::size_t> sharpness = {};
};
CommandColumns columns_of(const CommandPath& path);

/// Commands as they reach the wheels, with derivatives with respect to the free quantities of their
/// path.
struct DelayedCommand {
  HeldCommand command;
  /// d force / d delay, 1/s, of motors with lag. Without lag, LinearStepper::change_command() adds
  /// the derivative with respect to a delay.
  SideForces<double> by_delay{};
  SideForces<double> by_lag{};         ///< d force / d time constant of the motors, 1/s
  SideForces<double> by_imbalance{};   ///< d force / d imbalance
  SideForces<double> by_exponent{};    ///< d force / d ln p
  SideForces<double> by_saturation{};  ///< d force / d L
  SideForces<double> by_sharpness{};   ///< d force / d ln n
  double steering_by_trim = 0.0;       ///< d steering / d trim: 1 if there is a trim, else 0
  double steering_by_dead_band = 0.0;  ///< d steering / d dead band
  double steering_by_asymmetry = 0.0;  ///< d steering / d asymmetry, rad
};

/// Calls visit(column, by) for each free quantity that changes the forces of `command`. `by`:
/// derivative of the forces with respect to this quantity.
template <class Visit>
void for_each_force_column(const CommandColumns& c, const DelayedCommand& command, Visit visit) {
  if (c.delay) visit(*c.delay, command.by_delay);
  if (c.lag) visit(*c.lag, command.by_lag);
  if (c.imbalance) visit(*c.imbalance, command.by_imbalance);
  if (c.exponent) visit(*c.exponent, command.by_exponent);
  if (c.saturation) visit(*c.saturation, command.by_saturation);
  if (c.sharpness) visit(*c.sharpness, command.by_sharpness);
}

/// Rows of the log whose force commands and whose steering command act at one time. The two rows
/// differ if the steering has its own delay.
struct ActingRows {
  std::size_t forces;
  std::size_t steering;
};

/// The logged commands of these rows, changed by the constant errors of the path. Delay and lag are
/// not applied.
DelayedCommand command_of_rows(const DrivingLog& log, const ActingRows& rows,
                               const CommandPath& path);

/// The command that reaches the wheels in the interval [t, t + h], in which the commands of `rows`
/// act. If the motors have a lag, the forces are means over this interval.
DelayedCommand command_over(const LogSignals& signals, const ActingRows& rows, double t_s,
                            double h_s, const CommandPath& path);

/// The command that reaches the wheels at the time t. If it changes exactly at t, returns the new
/// one.
DelayedCommand command_at(const LogSignals& signals, double t_s, const CommandPath& path);

}  // namespace awmr
