/// Simulation of a log like replay(), which also computes the derivatives of the motion with
/// respect to the free quantities of a log fit. Private to identify/.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/identify/logs/simulation/command_path.h"
#include "awmr/identify/logs/simulation/linear_stepper.h"
#include "awmr/trials/held_signal.h"

namespace awmr {

/// Integrates the motion, and its derivatives with respect to the columns of the fit, from `from_s`
/// to `to_s`. Both times lie between `row` and the next row. (advance_after_row() in
/// trials/replay.h integrates the motion alone.)
void advance_after_row(const LogSignals& signals, std::size_t row, double from_s, double to_s,
                       const CommandPath& path, LinearStepper& stepper, double longest_step_s,
                       LinearMotion& motion);

/// Sets the steering angle of `motion` to the logged angle plus the trim, at the fraction `share`
/// of the time from `row` to the next row. The derivative of the angle is 1 with respect to the
/// trim, and 0 with respect to all other quantities.
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

/// Returns the motion at an earlier time: delay.value >= 0 seconds before the last of `motions`,
/// which are the motions at the rows from `begin` on. Integrates from the last row before that
/// time. Before the row `begin`, extrapolates with the accelerations at this row.
LinearMotion earlier_motion(const LogSignals& signals, std::size_t begin,
                            const std::vector<LinearMotion>& motions, LinearStepper& stepper,
                            const TermColumn& delay, double longest_step_s,
                            const CommandPath& path);

}  // namespace awmr
