/// replay() with the derivatives of the motion by the free quantities of a fit. Private to
/// identify/.
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

/// The state at one time and its derivatives by the columns of a fit, [kStateSize][columns]; empty
/// if only the state is requested.
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

/// A delay or a lag and the column that its derivatives fill.
struct DelayColumn {
  double delay_s;
  std::size_t column;
};

/// A constant error of the commands and the column that its derivatives fill.
struct OffsetColumn {
  double value;
  std::size_t column;
};

/// Path of the logged commands to the wheels: direct, delayed, through motor lag, or with a
/// constant error.
struct CommandPath {
  std::optional<DelayColumn> delay = {};  ///< of all commands; negative: their time stamps are late
  std::optional<DelayColumn> steering_delay = {};  ///< of the steering, on top of that
  std::optional<LaggedForces> lag = {};
  std::optional<std::size_t> lag_column = {};      ///< present if the lag is free
  std::optional<OffsetColumn> steering_trim = {};  ///< rad, added to command or logged angle
  std::optional<OffsetColumn> imbalance = {};  ///< e: left forces times 1 - e, right times 1 + e
  /// A motor is off as soon as its command is 0, whatever its lag: true for motors with back-EMF.
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

/// The commands as they reach the wheels, and their derivatives with respect to the free quantities
/// of their path.
struct DelayedCommand {
  HeldCommand command;
  SideForces<double> by_delay{};  ///< of motors with lag; see LinearStepper::change_command()
  SideForces<double> by_lag{};
  SideForces<double> by_imbalance{};
  double steering_by_trim = 0.0;  ///< 1 with a trim, of a logged angle too
};

/// Integrates the state and its derivatives.
class LinearStepper {
 public:
  /// `columns`: 0 for the state alone. `command_columns`: columns_of() the command path. `longest_step_s`:
  /// as for LinearPlant.
  LinearStepper(const Plant<double>& plant, std::size_t columns,
                const std::vector<ParameterColumn>& parameters,
                const CommandColumns& command_columns, double longest_step_s = 0.0);
  /// One classical Runge-Kutta step of h seconds with friction, as rk4_step_with_friction().
  void step(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// Makes one step along the rates at the present state, which are returned; h of either sign.
  State<double> step_along_tangent(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// Adds the derivatives by the delays at a change of the commands from `before` to `after`: a
  /// longer delay makes the motion follow `before` for longer.
  ///     dS = rates before - rates after
  void change_command(const DelayedCommand& before, const DelayedCommand& after,
                      LinearMotion& motion);
  /// The rates of the state.
  State<double> rates(const DelayedCommand& command, LinearMotion& motion);

  std::size_t columns() const { return columns_; }

 private:
  /// A nonzero derivative of rates_ and its destination.
  struct Term {
    std::size_t parameter;
    double DrivenSlopes::*rate;
    std::size_t place;  ///< [kDrivenSize][columns]
    double factor;
  };
  void note_driven(const DelayedCommand& command, double* driven) const;
  /// Fills a column by the derivatives of the commands.
  void set_column(const HeldCommand& by, std::size_t column, double* driven) const;
  /// The rates and their derivatives at `s`, friction included.
  void find_rates(const DelayedCommand& command, const State<double>& s);
  /// Sets the direction in which each speed of `motion` moves from here on. A speed held at 0 by
  /// friction has zero derivatives.
  void find_way(const DelayedCommand& command, LinearMotion& motion);
  /// Returns the state after h seconds, and keeps what move_to() needs for the derivatives.
  State<double> state_after(const DelayedCommand& command, double h_s, const State<double>& from);
  /// Moves the state to `next`, that of the last state_after(), and its derivatives with it.
  void move_to(const State<double>& next, double h_s, LinearMotion& motion);
  /// Keeps a speed that has reached 0 at rest, or continues in the other direction.
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

/// Moves the motion from `from_s` to `to_s`, times between `row` and the next one, as
/// advance_after_row() does.
void advance_after_row(const LogSignals& signals, std::size_t row, double from_s, double to_s,
                       const CommandPath& path, LinearStepper& stepper, double longest_step_s,
                       LinearMotion& motion);

/// Sets the steering to the logged angle at a fraction of the time from a row to the next. Its
/// derivatives depend on its trim alone.
void steer(const LogSignals& signals, std::size_t row, double share, const CommandPath& path,
           std::size_t columns, LinearMotion& motion);

/// Runs the model over rows [begin, end) from `motion` and calls visit(row, motion) at every row,
/// as replay() does.
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

/// The motion at delay.delay_s >= 0 before the last of `motions`, which are the motions at the rows
/// from `begin` on. Integrated by Runge-Kutta steps from the preceding row. Before the first row,
/// its rates are extrapolated.
LinearMotion earlier_motion(const LogSignals& signals, std::size_t begin,
                            const std::vector<LinearMotion>& motions, LinearStepper& stepper,
                            const DelayColumn& delay, double longest_step_s,
                            const CommandPath& path);

}  // namespace awmr
