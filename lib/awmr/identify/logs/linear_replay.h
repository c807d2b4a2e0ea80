/// replay() with the derivatives of the motion by the free numbers of a fit. Private to identify/.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "awmr/identify/logs/linear_rates.h"
#include "awmr/identify/logs/sensitivity_kernel.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// The state at a moment and its derivatives by the columns of a fit, [kStateSize][columns]; none of
/// them where only the state is asked for.
struct LinearMotion {
  State<double> state{};
  std::vector<double> by_column;

  const double* row(LogChannel channel, std::size_t columns) const;
  double* row(LogChannel channel, std::size_t columns);
};

/// A parameter whose derivatives fill a column.
struct ParameterColumn {
  ParameterId id;
  std::size_t column;
  double factor;  ///< d parameter / d coordinate
};

/// A delay whose derivatives fill a column: of all commands, where a negative one says that they were
/// logged late; of a sensor; or the time constant of the motors.
struct DelayColumn {
  double delay_s;
  std::size_t column;
};

/// Wheel forces behind motors that lag by the time constant T, with the derivatives by T. While the
/// command is c:
///
///     F'(t + h) = c + (F'(t) - c) e,   e = exp(-h/T)
///     mean over h: c + (F'(t) - c) (T/h) (1 - e)
///
/// It begins with F' = c so many time constants before the rows, or at the log's first row, that an
/// earlier command has less weight than rounding.
class LaggedForces {
 public:
  /// For the rows [begin, end) of the log.
  LaggedForces(const DrivingLog& log, std::size_t begin, std::size_t end, const DelayColumn& lag);
  /// The mean over [t, t + h], which begins `since_row_s` after the row and ends before the next.
  struct Mean {
    SideForces<double> force;
    SideForces<double> by_lag;
  };
  Mean mean(std::size_t row, double since_row_s, double h_s) const;
  std::size_t column() const { return column_; }

 private:
  const DrivingLog* log_;
  double lag_s_;
  std::size_t column_;
  std::size_t first_row_;                   ///< of the two below
  std::vector<SideForces<double>> force_;   ///< by row
  std::vector<SideForces<double>> by_lag_;  ///< by row
};

/// How the logged commands reach the wheels: at once, after a delay, or through motors that lag.
struct CommandPath {
  std::optional<DelayColumn> delay;
  std::optional<LaggedForces> lag;

  std::optional<std::size_t> column() const;
};

/// The commands as they reach the wheels, and their derivatives by the delay or the lag.
struct DelayedCommand {
  HeldCommand command;
  HeldCommand by_delay{};
};

/// Moves the state and its derivatives on.
class LinearStepper {
 public:
  /// `columns`: 0 for the state alone. `late_column`: of the command path's delay or lag.
  /// `longest_step_s`: of LinearPlant.
  LinearStepper(const Plant<double>& plant, std::size_t columns,
                const std::vector<ParameterColumn>& parameters,
                std::optional<std::size_t> late_column, double longest_step_s = 0.0);
  /// One classical Runge-Kutta step of h seconds with friction, as rk4_step_with_friction().
  void step(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// One step along the rates where it stands, which are returned; h of either sign.
  State<double> step_along_tangent(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// The state's rates there.
  State<double> rates(const DelayedCommand& command, LinearMotion& motion);

  std::size_t columns() const { return columns_; }

 private:
  /// A derivative of rates_ that counts, and where it goes.
  struct Term {
    std::size_t parameter;
    double DrivenSlopes::*rate;
    std::size_t place;  ///< [kDrivenSize][columns]
    double factor;
  };
  void note_driven(const DelayedCommand& command, double* driven) const;
  /// The rates and their derivatives at `s`, friction included.
  void find_rates(const DelayedCommand& command, const State<double>& s);
  /// Which way `motion` slides from here on. What is held has no derivatives left.
  void find_way(const DelayedCommand& command, LinearMotion& motion);
  /// The state h seconds on, and what the derivatives need to follow.
  State<double> state_after(const DelayedCommand& command, double h_s, const State<double>& from);
  /// Moves the state to `next`, that of the last state_after(), and its derivatives with it.
  void move_to(const State<double>& next, double h_s, LinearMotion& motion);
  /// Takes a speed that has come to 0 to rest, or on the other way.
  void stop(LogChannel speed, const DelayedCommand& command, LinearMotion& motion);

  LinearPlant plant_;
  std::size_t columns_;
  std::optional<std::size_t> late_column_;
  std::vector<Term> terms_;
  Sliding way_;
  LinearRates rates_;
  std::array<StateSlopes, kStages> slopes_{};
  std::vector<double> driven_;  ///< [kStages][kDrivenSize][columns]
};

/// The command over [t, t + h].
DelayedCommand command_at(const LogSignals& signals, std::size_t row, double t_s, double h_s,
                          const CommandPath& path);

/// Runs the model over rows [begin, end) from `motion` and calls visit(row, motion) at every row, as
/// replay() does.
template <class Visit>
void replay_linear(const LogSignals& signals, std::size_t begin, std::size_t end,
                   const CommandPath& path, LinearStepper& stepper, double longest_step_s,
                   LinearMotion motion, Visit visit) {
  const DrivingLog& log = *signals.log;
  const bool servo = log.steering_command_rad.has_value();
  const std::size_t columns = stepper.columns();
  // A logged angle is what it is, whatever the parameters are.
  const auto steer = [&](std::size_t row, double share) {
    const std::vector<double>& angle = log[LogChannel::kSteering]->value;
    motion.state.steering_rad =
        angle[row] + share * (angle[std::min(row + 1, log.rows() - 1)] - angle[row]);
    double* const by_column = motion.row(LogChannel::kSteering, columns);
    std::fill(by_column, by_column + columns, 0.0);
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
        command.by_delay.steering_rad = 0.0;
      }
      stepper.step(command, h, motion);
    }
  }
}

/// The motion delay.delay_s >= 0 before the last of `motions`, the motions at the rows from `begin`
/// on: so many Runge-Kutta steps from the row before. Before the first row the rates there hold.
LinearMotion earlier_motion(const LogSignals& signals, std::size_t begin,
                            const std::vector<LinearMotion>& motions, LinearStepper& stepper,
                            const DelayColumn& delay, double longest_step_s);

}  // namespace awmr
