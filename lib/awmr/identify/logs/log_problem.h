/// The least-squares problem of a fit of logs. Private to identify/.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/identify/logs/residuals.h"

namespace awmr {

/// Standard deviation of the prior at the initial guess, relative to the quantity's large change.
inline constexpr double kPriorStd = 5.0;

/// The cost is half the sum of squares of the residuals of all windows and of a prior of every
/// coordinate at its initial guess,
///
///     (x_i - initial_i) / (kPriorStd large_change_i)
///
/// which is weak compared with informative data, but keeps coordinates without data at their guess.
struct LogProblem {
  LogModel model;
  std::vector<FitWindow> windows;
  std::vector<double> initial;   ///< coordinate of the initial guess, by quantity
  std::vector<Interval> bounds;  ///< of the coordinate, by quantity
  int threads = 0;               ///< 0: every core
  std::optional<std::chrono::steady_clock::time_point> deadline;  ///< of all searches
  std::shared_ptr<Effort> effort;                                 ///< of all searches
  bool ends_at_limit = true;  ///< the search stops at the limit of effort

  /// Number of free numbers: the quantities, and the initial state of every window.
  std::size_t unknowns() const {
    return model.quantities.size() + model.initial.size() * windows.size();
  }
};

/// The numbers that a search moves.
struct SearchPoint {
  std::vector<double> coordinates;     ///< by quantity
  std::vector<double> initial_states;  ///< by window, then by component
};

/// Longest integration step at these coordinates, s: as replay_step_s(), but sway is not resolved
/// between the rows of a log (LinearPlant::sway_pace), nor a servo with a time constant below a
/// sixteenth of the row spacing.
double step_s_at(const LogModel& model, const std::vector<double>& coordinates);

/// The problem at the initial guess, with sensor noise and without outlier weights. The logs must
/// outlive it.
LogProblem log_problem(const std::vector<DrivingLog>& logs, const LogFitOptions& options);

/// The coordinates with the measured initial state of every window.
SearchPoint from_measured(const LogProblem& problem, std::vector<double> coordinates);

/// Searches that only rank the initial guesses integrate with steps longer by this factor.
inline constexpr double kRoughStep = 2.0;

/// The errors and the sums of every window, computed in parallel. The result does not depend on the
/// number of threads. `block_s`: of sums_of().
std::vector<WindowErrors> errors_at(const LogProblem& problem, const SearchPoint& point);
std::vector<WindowSums> sums_at(const LogProblem& problem, const SearchPoint& point,
                                double block_s = 0.0);

/// False if the simulation of a window is not finite.
bool all_finite(const std::vector<WindowErrors>& errors);
bool all_finite(const std::vector<WindowSums>& sums);

}  // namespace awmr
