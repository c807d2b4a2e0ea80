/// The least-squares problem of a fit of logs. Private to identify/.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/identify/logs/residuals.h"

namespace awmr {

/// Standard deviation of the pull to the initial guess, over the quantity's large change.
inline constexpr double kPriorStd = 5.0;

/// Half the sum of squares of: every window's residuals, and a pull of every coordinate to its
/// initial guess,
///
///     (x_i - initial_i) / (kPriorStd large_change_i)
///
/// so weak that informative data outweigh it, while coordinates without data keep their guess.
struct LogProblem {
  LogModel model;
  std::vector<FitWindow> windows;
  std::vector<double> initial;   ///< coordinate of the initial guess, by quantity
  std::vector<Interval> bounds;  ///< of the coordinate, by quantity
  int threads = 0;               ///< 0: every core
  std::optional<std::chrono::steady_clock::time_point> deadline;  ///< of every search
  std::shared_ptr<Effort> effort;                                 ///< of all searches
  bool ends_at_limit = true;  ///< the search stops once the effort is over

  /// Free numbers: the quantities, and an initial state for every window.
  std::size_t unknowns() const {
    return model.quantities.size() + model.initial.size() * windows.size();
  }
};

/// The numbers that a search moves.
struct SearchPoint {
  std::vector<double> coordinates;     ///< by quantity
  std::vector<double> initial_states;  ///< by window, then by component
};

/// The longest step that follows the motion at these coordinates, s: as replay_step_s(), but sway need
/// not be followed between the rows of a log (LinearPlant::sway_pace).
double step_s_at(const LogModel& model, const std::vector<double>& coordinates);

/// The problem at the initial guess: sensor noise, no outlier weighed down. The logs must outlive
/// it.
LogProblem log_problem(const std::vector<DrivingLog>& logs, const LogFitOptions& options);

/// The coordinates with every window's initial state as it was measured.
SearchPoint from_measured(const LogProblem& problem, std::vector<double> coordinates);

/// Searches that only rank the initial guesses integrate with steps longer by this factor.
inline constexpr double kRoughStep = 2.0;

/// The errors and the sums of every window, in parallel, each on its own, so that the result does not
/// depend on the number of threads. `block_s`: of sums_of().
std::vector<WindowErrors> errors_at(const LogProblem& problem, const SearchPoint& point);
std::vector<WindowSums> sums_at(const LogProblem& problem, const SearchPoint& point,
                                double block_s = 0.0);

/// False where a window's simulation left the finite numbers: its errors are then no errors.
bool all_finite(const std::vector<WindowErrors>& errors);
bool all_finite(const std::vector<WindowSums>& sums);

}  // namespace awmr
