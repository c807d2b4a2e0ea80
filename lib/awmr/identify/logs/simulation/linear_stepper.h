/// Integration of the vehicle's state together with its derivatives with respect to the free
/// quantities of a log fit. Private to identify/.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/identify/logs/simulation/command_path.h"
#include "awmr/identify/logs/simulation/linear_rates.h"
#include "awmr/identify/logs/simulation/sensitivity_kernel.h"
#include "awmr/trials/log.h"

namespace awmr {

/// State at one time, with its derivatives with respect to the columns of a fit. A column is an
/// unknown of the fit: a free quantity, a free component of the initial state, or an uncertain time
/// of a command change.
struct LinearMotion {
  State<double> state{};
  /// Derivatives of the state, [kStateSize][columns], in the order of LogChannel; empty if there
  /// are no columns.
  std::vector<double> by_column;
  /// Derivatives of the component `channel` of the state, one per column.
  const double* row(LogChannel channel, std::size_t columns) const {
    return by_column.data() + at(channel) * columns;
  }
  double* row(LogChannel channel, std::size_t columns) {
    return by_column.data() + at(channel) * columns;
  }
};

/// A model parameter that depends on an unknown of the fit, and the column of this unknown. Several
/// parameters may depend on one unknown.
struct ParameterColumn {
  ParameterId id;
  std::size_t column;
  double factor;  ///< d parameter / d coordinate
};

class LinearStepper {
 public:
  /// `columns`: number of columns, the unknowns of the fit with respect to which the state is
  /// differentiated; 0: only the state is computed. `parameters`: the columns that are model
  /// parameters. `terms`: those of the command path. `longest_step_s`, `extra`: as for
  /// LinearPlant.
  LinearStepper(const Plant<double>& plant, std::size_t columns,
                const std::vector<ParameterColumn>& parameters, const CommandTerms& terms,
                double longest_step_s = 0.0, const ExtraForces& extra = {});
  /// Makes one classical Runge-Kutta step of h_s seconds with friction, like step_with_friction().
  void step(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// Makes one Euler step of h_s seconds (of either sign). Returns the rates before the step.
  State<double> step_along_tangent(const DelayedCommand& command, double h_s, LinearMotion& motion);
  /// Updates S, the derivatives of the motion with respect to the delays, at a jump of the commands
  /// from `before` to `after`. With a longer delay, the motion follows `before` for longer, so
  ///
  ///     S += rates before - rates after
  ///
  /// The additional delay of the steering changes only the derivative of the steering angle.
  ///
  /// Also updates the derivatives with respect to the times of ramps that are 0 (ramp_impulses()).
  void change_command(const DelayedCommand& before, const DelayedCommand& after,
                      LinearMotion& motion);
  /// Updates the derivatives of the motion with respect to the time of this jump in the same way.
  /// `column`: index of this time among the columns.
  void change_time(std::size_t column, const DelayedCommand& before, const DelayedCommand& after,
                   LinearMotion& motion);
  /// Returns the rates of the state, friction included. If friction holds a speed at 0, sets the
  /// derivatives of this speed with respect to the columns, in `motion`, to 0.
  State<double> rates(const DelayedCommand& command, LinearMotion& motion);

  std::size_t columns() const { return columns_; }

 private:
  /// Place in driven_ of the derivative of one rate of the state with respect to a parameter.
  struct Term {
    std::size_t parameter;
    double DrivenSlopes::*rate;
    std::size_t place;  ///< index in a part of driven_, [kDrivenSize][columns]
    double factor;
    bool adds;  ///< true: an earlier term has the same place
  };
  void note_driven(const DelayedCommand& command, double* driven) const;
  /// Adds the effect of an impulse of the forces on the derivatives with respect to `column`.
  /// `area`: integral of the impulse over time. Uses the derivatives of the last find_rates().
  void add_impulse(std::size_t column, const SideForces<double>& area, LinearMotion& motion);
  /// Sets the derivatives of the state's rates of change with respect to the quantity with the
  /// index `column`, which changes the commands. `by`: derivatives of the commands with respect to
  /// it.
  void set_column(const HeldCommand& by, std::size_t column, double* driven) const;
  /// If another change of the commands acts than before (DelayedCommand::change_column), sets the
  /// derivatives of the rates with respect to the time of the previous change to 0.
  void follow_change(const DelayedCommand& command);
  /// Sets rates_: the rates of the state at the state `s` and their derivatives (LinearRates),
  /// friction included.
  void find_rates(const DelayedCommand& command, const State<double>& s);
  /// Sets way_, the direction in which u and r move next. If friction holds a speed at 0, sets the
  /// derivatives of this speed with respect to the columns, in `motion`, to 0.
  void find_way(const DelayedCommand& command, LinearMotion& motion);
  /// Returns the state after one Runge-Kutta step of h_s seconds. If there are columns (unknowns of
  /// the fit), stores the derivatives of the state's rates of change with respect to the state
  /// (slopes_) and to the columns (driven_) at each stage. move_to() needs them.
  State<double> state_after(const DelayedCommand& command, double h_s, const State<double>& from);
  /// Sets the state of `motion` to `next`, the result of the last state_after(). Advances the
  /// derivatives of the state with respect to the unknowns of the fit (a column of the Jacobian
  /// each) by the same step of h_s seconds.
  void move_to(const State<double>& next, double h_s, LinearMotion& motion);
  /// Handles a speed w (u or r) that has reached 0: friction holds it at 0, or it changes its sign.
  /// Multiplies the derivatives of w with respect to the columns by the ratio of two accelerations:
  /// w_dot after the stop, divided by w_dot before it. stop() in the .cpp file derives this factor.
  void stop(LogChannel speed, const DelayedCommand& command, LinearMotion& motion);

  LinearPlant plant_;
  std::size_t columns_;
  CommandTerms command_terms_;
  std::vector<Term> terms_;
  Sliding<double> way_;
  LinearRates rates_;
  std::array<StateSlopes, kStages> slopes_{};
  std::optional<std::size_t> change_column_;  ///< of the change that acted last
  /// Derivatives of the state's rates of change with respect to the columns,
  /// [kStages][kDrivenSize][columns].
  std::vector<double> driven_;
};

}  // namespace awmr
