/// Simulation of a log like replay(), with the derivatives of the motion by the free quantities of
/// a log fit. Private to identify/.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "awmr/identify/logs/linear_rates.h"
#include "awmr/identify/logs/sensitivity_kernel.h"
#include "awmr/trials/lagged_forces.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// State at one time with its derivatives by the columns of a fit. A column is a free quantity or a
/// free component of the initial state.
struct LinearMotion {
  State<double> state{};
  std::vector<double> by_column;  ///< derivatives, [kStateSize][columns]; empty without columns
  /// Derivatives of one component of the state, one per column. `channel`: the component.
  const double* row(LogChannel channel, std::size_t columns) const;
  double* row(LogChannel channel, std::size_t columns);
};

/// A free parameter and the column of its derivatives.
struct ParameterColumn {
  ParameterId id;
  std::size_t column;
  double factor;  ///< d parameter / d coordinate
};

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
  std::optional<DelayColumn> delay = {};           ///< of all commands; negative: late time stamps
  std::optional<DelayColumn> steering_delay = {};  ///< of the steering, in addition to `delay`
  std::optional<LaggedForces> lag = {};            ///< forces after the motors' lag
  std::optional<std::size_t> lag_column = {};      ///< column of the lag; present if it is free
  std::optional<OffsetColumn> steering_trim = {};  ///< rad, added to command or logged angle
  /// Dead band, rad, and asymmetry e of steering_asymmetry(); not for logs with measured angles.
  std::optional<OffsetColumn> steering_dead_band = {};
  std::optional<OffsetColumn> steering_asymmetry = {};
  std::optional<OffsetColumn> servo_rate = {};  ///< rate limit, rad/s, in place of the plant's
  std::optional<OffsetColumn> imbalance = {};   ///< e: left forces times 1 - e, right times 1 + e
  std::optional<OffsetColumn> exponent = {};    ///< p of force_exponent(); derivatives by ln p
  std::optional<OffsetColumn> saturation = {};  ///< L of force_saturation()
  double full_command = 1.0;                    ///< F'm of force_saturation()
  std::optional<OffsetColumn> sharpness = {};   ///< n; the derivatives are by ln n
  /// True (motors with back-EMF): a motor is off as soon as its command is 0, regardless of its
  /// lag.
  bool switches_off = false;
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

/// Commands as they reach the wheels, with derivatives by the free quantities of their path.
struct DelayedCommand {
  HeldCommand command;
  /// d force / d delay, 1/s, of motors with lag. Without lag, the derivative by a delay is added by
  /// LinearStepper::change_command().
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
/// derivative of the forces by this quantity.
template <class Visit>
void for_each_force_column(const CommandColumns& c, const DelayedCommand& command, Visit visit) {
  if (c.delay) visit(*c.delay, command.by_delay);
  if (c.lag) visit(*c.lag, command.by_lag);
  if (c.imbalance) visit(*c.imbalance, command.by_imbalance);
  if (c.exponent) visit(*c.exponent, command.by_exponent);
  if (c.saturation) visit(*c.saturation, command.by_saturation);
  if (c.sharpness) visit(*c.sharpness, command.by_sharpness);
}

/// The command that reaches the wheels at the time t. A change exactly at t is included.
DelayedCommand command_at(const LogSignals& signals, double t_s, const CommandPath& path);

/// Integrates the state and its derivatives step by step.
class LinearStepper {
 public:
  /// `columns`: number of derivatives; 0: the state alone is computed. `parameters`: the columns
  /// that belong to model parameters. `command_columns`: columns_of() of the command path.
  /// `longest_step_s`, `extra`: as for LinearPlant.
  LinearStepper(const Plant<double>& plant, std::size_t columns,
                const std::vector<ParameterColumn>& parameters,
                const CommandColumns& command_columns, double longest_step_s = 0.0,
                const ExtraForces& extra = {});
  /// Makes one classical Runge-Kutta step of h_s seconds with friction, like
  /// rk4_step_with_friction().
  void step(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// Makes one Euler step of h_s seconds (of either sign). Returns the rates before the step.
  State<double> step_along_tangent(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// Updates S, the derivatives with respect to the delays, at a change of the commands from
  /// `before` to `after`. A longer delay makes the motion follow `before` for longer, so
  ///     S += rates before - rates after
  /// The steering delay changes only the derivative of the steering angle.
  void change_command(const DelayedCommand& before, const DelayedCommand& after,
                      LinearMotion& motion);
  /// The rates of the state, friction included. Sets the derivatives of a held speed to 0.
  State<double> rates(const DelayedCommand& command, LinearMotion& motion);

  std::size_t columns() const { return columns_; }

 private:
  /// A derivative of one rate by a parameter, and its destination in driven_.
  struct Term {
    std::size_t parameter;
    double DrivenSlopes::*rate;
    std::size_t place;  ///< index in an array [kDrivenSize][columns]
    double factor;
  };
  void note_driven(const DelayedCommand& command, double* driven) const;
  /// Sets a column to the derivatives of the rates by a quantity that acts through the commands.
  void set_column(const HeldCommand& by, std::size_t column, double* driven) const;
  /// Computes the rates and their derivatives at `s`, friction included.
  void find_rates(const DelayedCommand& command, const State<double>& s);
  /// Sets way_, the direction in which u and r move next. For a speed that friction holds at 0,
  /// sets its derivatives in `motion` to 0.
  void find_way(const DelayedCommand& command, LinearMotion& motion);
  /// Returns the state after h_s seconds. Stores the stages that move_to() needs for the
  /// derivatives.
  State<double> state_after(const DelayedCommand& command, double h_s, const State<double>& from);
  /// Moves state and derivatives of `motion` to `next`, the result of the last state_after().
  void move_to(const State<double>& next, double h_s, LinearMotion& motion);
  /// Handles a speed that has reached 0: friction keeps it at 0, or it continues in the other
  /// direction. Scales the derivatives of this speed accordingly.
  void stop(LogChannel speed, const DelayedCommand& command, LinearMotion& motion);

  LinearPlant plant_;
  std::size_t columns_;
  CommandColumns command_columns_;
  std::vector<Term> terms_;
  Sliding way_;
  LinearRates rates_;
  std::array<StateSlopes, kStages> slopes_{};
  std::vector<double> driven_;  ///< [kStages][kDrivenSize][columns]
};

/// Integrates the motion from `from_s` to `to_s`, times between `row` and the next row, like
/// advance_after_row() in trials/replay.h, with derivatives.
void advance_after_row(const LogSignals& signals, std::size_t row, double from_s, double to_s,
                       const CommandPath& path, LinearStepper& stepper, double longest_step_s,
                       LinearMotion& motion);

/// Sets the steering angle of `motion` to the logged angle plus the trim, at the fraction `share`
/// of the time from `row` to the next row. Its derivative is 1 by the trim and 0 by other columns.
void steer(const LogSignals& signals, std::size_t row, double share, const CommandPath& path,
           std::size_t columns, LinearMotion& motion);

/// Simulates rows [begin, end) from `motion` and calls visit(row, motion) at every row, like
/// replay().
template <class Visit>
void replay_linear(const LogSignals& signals, std::size_t begin, std::size_t end,
                   const CommandPath& path, LinearStepper& stepper, double longest_step_s,
                   LinearMotion motion, Visit visit) {
  const DrivingLog& log = *signals.log;
  for (std::size_t row = begin; row < end; ++row) {
    if (!log.steering_command_rad) steer(signals, row, 0.0, path, stepper.columns(), motion);
    visit(row, motion);
    if (row + 1 == end) return;
    advance_after_row(signals, row, log.t_s[row], log.t_s[row + 1], path, stepper, longest_step_s,
                      motion);
  }
}

/// Returns the motion delay.delay_s >= 0 seconds before the last of `motions`. `motions` are the
/// motions at the rows from `begin` on. Integrates from the last row before that time. If that time
/// is before the first of these rows, extrapolates with the rates at the first row.
LinearMotion earlier_motion(const LogSignals& signals, std::size_t begin,
                            const std::vector<LinearMotion>& motions, LinearStepper& stepper,
                            const DelayColumn& delay, double longest_step_s,
                            const CommandPath& path);

}  // namespace awmr
