/// Path of the logged commands to the wheels: delays, motor lag and constant errors. A log fit
/// needs the derivatives of the commands at the wheels with respect to the free quantities. A
/// "column" is the index of a free quantity among these derivatives. Private to identify/.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "awmr/core/index.h"
#include "awmr/identify/logs/problem/quantities.h"
#include "awmr/identify/logs/problem/uncertain_changes.h"
#include "awmr/identify/logs/simulation/linear_rates.h"
#include "awmr/identify/logs/simulation/ramped_forces.h"
#include "awmr/trials/lagged_forces.h"

namespace awmr {

/// Value of a free quantity, and its column: its index among the unknowns of the fit
/// (linear_stepper.h).
struct TermColumn {
  double value;
  std::size_t column;
};

/// One T for each kind of quantity up to `kLast`.
template <class T, FreeQuantity::Kind kLast>
struct ByKind {
  std::array<T, at(kLast) + 1> of_kind{};

  T& operator[](FreeQuantity::Kind kind) { return of_kind[at(kind)]; }
  const T& operator[](FreeQuantity::Kind kind) const { return of_kind[at(kind)]; }
};

/// Terms that the fit estimates, with the units and definitions of FreeQuantity::Kind. The column
/// of a term whose coordinate is a logarithm is that of the logarithm.
struct TermColumns : ByKind<std::optional<TermColumn>, FreeQuantity::Kind::kCompassCos2> {
  /// Value of a term; `otherwise` if the fit does not estimate it.
  double value(FreeQuantity::Kind kind, double otherwise = 0.0) const {
    const std::optional<TermColumn>& term = (*this)[kind];
    return term ? term->value : otherwise;
  }
};

/// Last kind of the terms between the logged commands and the wheels; the first is kDelay.
inline constexpr auto kLastOfCommands = FreeQuantity::Kind::kForceScale;

struct CommandTerms : TermColumns {
  bool turns_slowly = false;  ///< RampTimes::turns_slowly
};

/// Delays, lag and constant errors between the logged commands and the wheels.
struct CommandPath {
  /// Without dead band, asymmetry, curve and scale error of the steering for logs with measured
  /// steering angles.
  CommandTerms terms = {};
  /// Forces after the motors' lag, whose time constant is fixed or a term.
  std::optional<LaggedForces> lag = {};
  /// Forces after the ramps and the lag, instead of `lag`. Absent without ramps among the terms,
  /// and if the forces jump because both times are 0 (with a delay, but without a lag).
  std::optional<RampedForces> ramps = {};
  double steering_stop_rad = 1.0;  ///< d_max of the vehicle file, > 0
  /// True: the stop limits the command, before the errors of the linkage act. False: the plant
  /// limits the angle.
  bool stop_limits_command = false;
  double full_command = 1.0;  ///< largest command F'm of the logs
  /// True for motors with back-EMF: a motor whose command is 0 has no back-EMF and no force (or
  /// kRunOn times the force that the lag of earlier commands gives).
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
  double force_delay_s() const { return terms.value(FreeQuantity::Kind::kDelay); }
  double steering_delay_s() const {
    return force_delay_s() + terms.value(FreeQuantity::Kind::kSteeringDelay);
  }
};

/// Commands as they reach the wheels, and their derivatives with respect to the terms of
/// CommandPath.
struct DelayedCommand {
  HeldCommand command;
  /// The derivative of the forces with respect to the delay is set only for motors with lag or
  /// ramps. Without, the force jumps; then LinearStepper::change_command() adds the derivative.
  ByKind<HeldCommand, kLastOfCommands> by = {};
  /// Column of the latest change of the forces, if its time is uncertain. Set only for motors with
  /// lag. The derivative of the force with respect to this time is that with respect to the delay,
  /// because the effect of earlier changes is assumed to have decayed.
  std::optional<std::size_t> change_column = {};
};

/// Calls visit(column, by) for each term. `by`: derivative of the command with respect to it.
template <class Visit>
void for_each_column(const CommandTerms& terms, const DelayedCommand& command, Visit visit) {
  for (std::size_t kind = 0; kind < command.by.of_kind.size(); ++kind) {
    if (terms.of_kind[kind]) visit(terms.of_kind[kind]->column, command.by.of_kind[kind]);
  }
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
