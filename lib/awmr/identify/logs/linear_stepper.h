/// Integration of the vehicle's state together with its derivatives with respect to the free
/// quantities of a log fit. Private to identify/.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "awmr/identify/logs/command_path.h"
#include "awmr/identify/logs/linear_rates.h"
#include "awmr/identify/logs/sensitivity_kernel.h"
#include "awmr/trials/log.h"

namespace awmr {

/// State at one time with its derivatives with respect to the columns of a fit. A column is a free
/// quantity or a free component of the initial state.
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
  /// The rates of the state, friction included. For a speed that friction holds at 0, sets the
  /// derivatives in `motion` to 0.
  State<double> rates(const DelayedCommand& command, LinearMotion& motion);

  std::size_t columns() const { return columns_; }

 private:
  /// A derivative of one rate with respect to a parameter, and its destination in driven_.
  struct Term {
    std::size_t parameter;
    double DrivenSlopes::*rate;
    std::size_t place;  ///< index in an array [kDrivenSize][columns]
    double factor;
  };
  void note_driven(const DelayedCommand& command, double* driven) const;
  /// Sets a column to the derivatives of the rates with respect to a quantity that acts through the
  /// commands.
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
  /// Handles a speed that has reached 0: friction holds it at 0, or it changes its sign. Scales the
  /// derivatives of this speed accordingly.
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

}  // namespace awmr
