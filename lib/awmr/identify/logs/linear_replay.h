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
  std::vector<double> by_column;  ///< [kStateSize][columns]; empty for the state alone
  /// Derivatives of one component of the state, by column.

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

/// A constant error of the commands and the column of its derivatives.
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
  std::optional<OffsetColumn> imbalance = {};  ///< e: left forces times 1 - e, right times 1 + e
  /// True (motors with back-EMF): a motor is off as soon as its command is 0, whatever its lag.
  bool switches_off = false;
};

/// Columns of the free quantities of a command path.
struct CommandColumns {
  std::optional<std::size_t> delay = {};
  std::optional<std::size_t> steering_delay = {};
  std::optional<std::size_t> lag = {};
  std::optional<std::size_t> steering_trim = {};
  std::optional<std::size_t> imbalance = {};
};
CommandColumns columns_of(const CommandPath& path);

/// Commands as they reach the wheels, with derivatives by the free quantities of their path.
struct DelayedCommand {
  HeldCommand command;
  HeldCommand by_delay{};
  double steering_by_delay = 0.0;  ///< by the delay of the steering alone
  SideForces<double> by_lag{};
  SideForces<double> by_imbalance{};
  double steering_by_trim = 0.0;  ///< 1 if there is a trim, else 0
};

/// Integrates the state and its derivatives step by step.
class LinearStepper {
 public:
  /// `columns`: number of derivatives; 0: the state alone is computed. `command_columns`: columns_of() of the
  /// command path. `longest_step_s`: as for LinearPlant.
  LinearStepper(const Plant<double>& plant, std::size_t columns,
                const std::vector<ParameterColumn>& parameters,
                const CommandColumns& command_columns, double longest_step_s = 0.0);
  /// Makes one classical Runge-Kutta step of h_s seconds with friction, like
  /// rk4_step_with_friction().
  void step(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// Makes one Euler step of h_s seconds (of either sign). Returns the rates before the step.
  State<double> step_along_tangent(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// Rates of the state.
  State<double> rates(const DelayedCommand& command, LinearMotion& motion);

  std::size_t columns() const { return columns_; }

 private:
  /// A derivative of rates_ by a parameter and its destination in driven_.
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
  /// Sets way_, the direction in which each speed moves next. For a speed that friction holds at 0,
  /// sets the derivatives to 0.
  void find_way(const DelayedCommand& command, LinearMotion& motion);
  /// Returns the state after h_s seconds. Stores the stages that move_to() needs for the
  /// derivatives.
  State<double> state_after(const DelayedCommand& command, double h_s, const State<double>& from);
  /// Moves state and derivatives of `motion` to `next`, the result of the last state_after().
  void move_to(const State<double>& next, double h_s, LinearMotion& motion);
  /// Handles a speed that has reached 0: friction keeps it at rest, or it continues in the other
  /// direction. Adapts the derivatives.
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

/// Mean command at the wheels over [t_s, t_s + h_s].
DelayedCommand command_at(const LogSignals& signals, std::size_t row, double t_s, double h_s,
                          const CommandPath& path);

/// Simulates rows [begin, end) from `motion` and calls visit(row, motion) at every row, like
/// replay().
template <class Visit>
void replay_linear(const LogSignals& signals, std::size_t begin, std::size_t end,
                   const CommandPath& path, LinearStepper& stepper, double longest_step_s,
                   LinearMotion motion, Visit visit) {
  const DrivingLog& log = *signals.log;
  const bool servo = log.steering_command_rad.has_value();
  const std::size_t columns = stepper.columns();
  // A logged steering angle has no servo; it depends only on the trim.
  const auto steer = [&](std::size_t row, double share) {
    const std::vector<double>& angle = log[LogChannel::kSteering]->value;
    motion.state.steering_rad =
        angle[row] + share * (angle[std::min(row + 1, log.rows() - 1)] - angle[row]);
    if (path.steering_trim) motion.state.steering_rad += path.steering_trim->value;
    double* const by_column = motion.row(LogChannel::kSteering, columns);
    std::fill(by_column, by_column + columns, 0.0);
    if (path.steering_trim && columns > 0) by_column[path.steering_trim->column] = 1.0;
  };
  for (std::size_t row = begin; row < end; ++row) {
    if (!servo) steer(row, 0.0);
    visit(row, motion);
    if (row + 1 == end) return;
    const double span_s = log.t_s[row + 1] - log.t_s[row];
    const int steps = steps_in(span_s, longest_step_s);
    const double h = span_s / steps;
    for (int i = 0; i < steps; ++i) {
      DelayedCommand command = command_at(signals, row, log.t_s[row] + i * h, h, path);
      if (!servo) {
        steer(row, (i + 0.5) / steps);
        command.command.steering_rad = motion.state.steering_rad;
        command.by_delay.steering_rad = command.steering_by_delay = 0.0;
      }
      stepper.step(command, h, motion);
    }
  }
}

/// Motion at the time delay.delay_s >= 0 before the last of `motions`, which are the motions at the
/// rows from `begin` on. It is integrated from the row before that time, or extrapolated by the
/// rates if there is no such row. Of `errors` only the constant errors are used, not the delays.
LinearMotion earlier_motion(const LogSignals& signals, std::size_t begin,
                            const std::vector<LinearMotion>& motions, LinearStepper& stepper,
                            const DelayColumn& delay, double longest_step_s,
                            const CommandPath& errors = {});

}  // namespace awmr
