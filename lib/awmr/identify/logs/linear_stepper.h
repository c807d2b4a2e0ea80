/// Integration of the vehicle's state together with its derivatives with respect to the free
/// quantities of a log fit. Private to identify/.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "awmr/identify/logs/command_path.h"
#include "awmr/identify/logs/linear_rates.h"
#include "awmr/identify/logs/sensitivity_kernel.h"
#include "awmr/trials/log.h"

namespace awmr {

/// State at one time, with its derivatives with respect to the columns of a fit. A column is an
/// unknown of the fit: a free quantity, a free component of the initial state, or an uncertain time
/// of a command change.
struct LinearMotion {
  State<double> state{};
  /// Derivatives, [kStateSize][columns]; empty if there are no columns.
  std::vector<double> by_column;
  /// Derivatives of the component `channel` of the state, one per column.
  const double* row(LogChannel channel, std::size_t columns) const;
  double* row(LogChannel channel, std::size_t columns);
};

/// A free parameter and the column of its derivatives.
struct ParameterColumn {
  ParameterId id;
  std::size_t column;
  double factor;  ///< d parameter / d coordinate
};

class LinearStepper {
 public:
  /// `columns`: number of columns of the derivatives; 0: only the state is computed. `parameters`:
  /// columns of model parameters. `command_columns`: columns_of() of the command path.
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
  /// Updates S, the derivatives of the motion with respect to the delays, at a jump of the commands
  /// from `before` to `after`. With a longer delay, the motion follows `before` for longer, so
  ///
  ///     S += rates before - rates after
  ///
  /// The additional delay of the steering changes only the derivative of the steering angle.
  void change_command(const DelayedCommand& before, const DelayedCommand& after,
                      LinearMotion& motion);
  /// Does the same for the time of this jump, whose column is `column`.
  void change_time(std::size_t column, const DelayedCommand& before, const DelayedCommand& after,
                   LinearMotion& motion);
  /// Returns the rates of the state, friction included. If friction holds a speed at 0, sets the
  /// derivatives of this speed in `motion` to 0.
  State<double> rates(const DelayedCommand& command, LinearMotion& motion);

  std::size_t columns() const { return columns_; }

 private:
  /// Derivative of one rate with respect to a parameter, and its place in driven_.
  struct Term {
    std::size_t parameter;
    double DrivenSlopes::*rate;
    std::size_t place;  ///< index in a part of driven_, [kDrivenSize][columns]
    double factor;
  };
  void note_driven(const DelayedCommand& command, double* driven) const;
  /// Sets the derivatives of the rates with respect to a quantity that changes the commands. `by`:
  /// derivatives of the commands with respect to this quantity.
  void set_column(const HeldCommand& by, std::size_t column, double* driven) const;
  /// If another change acts than before (DelayedCommand::change_column), sets the derivatives of
  /// the rates with respect to the previous one to 0.
  void follow_change(const DelayedCommand& command);
  /// Computes the rates at the state `s` and their derivatives, friction included, into rates_.
  void find_rates(const DelayedCommand& command, const State<double>& s);
  /// Sets way_, the direction in which u and r move next. If friction holds a speed at 0, sets the
  /// derivatives of this speed in `motion` to 0.
  void find_way(const DelayedCommand& command, LinearMotion& motion);
  /// Returns the state after h_s seconds. Stores the derivatives of the rates at the Runge-Kutta
  /// stages for move_to().
  State<double> state_after(const DelayedCommand& command, double h_s, const State<double>& from);
  /// Sets the state of `motion` to `next`, the result of the last state_after(), and advances its
  /// derivatives by the same step.
  void move_to(const State<double>& next, double h_s, LinearMotion& motion);
  /// Handles a speed that has reached 0: friction holds it at 0, or the speed changes its sign.
  /// Multiplies its derivatives by the rate of this speed after the stop over that before.
  void stop(LogChannel speed, const DelayedCommand& command, LinearMotion& motion);

  LinearPlant plant_;
  std::size_t columns_;
  CommandColumns command_columns_;
  std::vector<Term> terms_;
  Sliding<double> way_;
  LinearRates rates_;
  std::array<StateSlopes, kStages> slopes_{};
  std::optional<std::size_t> change_column_;  ///< of the change that acted last
  std::vector<double> driven_;  ///< derivatives of the rates, [kStages][kDrivenSize][columns]
};

}  // namespace awmr
