/// Least-squares problem of a log fit (residuals, prior, bounds) and its solution. Private to
/// identify/.
#pragma once

#include <chrono>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit_options.h"
#include "awmr/identify/logs/problem/residuals.h"

namespace awmr {

/// Standard deviation of the weak prior of each coordinate, in large changes
/// (FreeQuantity::large_change). A smaller value would bias estimates towards their initial guess.
inline constexpr double kPriorStd = 5.0;

/// Data of the problem. The cost is half the sum of squares of two kinds of residuals: those of all
/// windows (parts of the logs, each with its own initial state), and a prior residual of every
/// coordinate x_i,
///
///     (x_i - initial_i) / (kPriorStd large_change_i)
///
/// The prior is weak compared with informative data, but keeps coordinates without data at their
/// initial guess.
struct LogProblem {
  LogModel model;
  std::vector<FitWindow> windows;
  std::vector<double> initial;                ///< one per quantity: coordinate of its initial guess
  std::vector<Interval> bounds;               ///< one per quantity: bounds of its coordinate
  std::vector<ParameterId> optional_coulomb;  ///< LogFitOptions::optional_coulomb
  Loss loss = Loss::kSquared;  ///< robust loss of the residuals; acts in settle_noise()
  int threads = 0;             ///< 0: every core
  std::optional<std::chrono::steady_clock::time_point> deadline;  ///< end of all searches
  std::shared_ptr<Effort> effort;                                 ///< work of all searches
  bool ends_at_limit = true;  ///< true: a search stops when `effort` reaches its limit

  /// Number of measurements of all channels in all windows.
  int readings() const;
  /// Number of unknowns: the quantities, and the free initial states of all windows.
  std::size_t unknowns() const {
    return model.quantities.size() + model.initial.size() * windows.size();
  }
};

struct SearchPoint {
  std::vector<double> coordinates;  ///< one per quantity
  /// All components of the first window, then of the next, ...
  std::vector<double> initial_states;
};

/// Longest integration step, s, at these coordinates. It is the step of replay_step_s() without
/// sway and servo, with these limits:
///   - Fast sway shortens the step to no less than 1/4 of the row spacing, and a fast servo to no
///     less than 1/8. (Still faster sway is slowed down, see LinearPlant::sway_pace.)
///   - The step is at most the row spacing. A longer step would lengthen the straight line that
///     replaces the resistance near rest (Resistance::rest_speed).
///   - The step is at most 5 ms if an excess of braking or backward forces is free, because braking
///     forces jump where a wheel changes its direction.
///   - The step is at least kShortestReplayStep_s.
double step_s_at(const LogModel& model, const std::vector<double>& coordinates);

/// Builds the least-squares problem at the initial guess, with the noise by sensor_noise() and the
/// weight 1 of all samples (a robust loss acts later). The logs must outlive the problem.
LogProblem log_problem(const std::vector<DrivingLog>& logs, const LogFitOptions& options);

/// Replaces the noise levels of the channels in `levels`, in each log by that of the same log, or by
/// that of all logs. Other channels keep theirs.
void set_noise(const NoiseLevels& levels, LogProblem& problem);

/// Returns the search point with these coordinates and the measured initial states of all windows.
SearchPoint from_measured(const LogProblem& problem, std::vector<double> coordinates);

/// Longest integration step, s, of rough searches (which only rank initial guesses or models) and
/// of the first round of settle_noise(). It is twice the step of the model, but at most the row
/// spacing.
double rough_step_s(const LogModel& model);

/// Compute the errors or the sums (WindowSums) of all windows in parallel. The results do not
/// depend on the number of threads. `block_s`: length of the blocks, see sums_of().
std::vector<WindowErrors> errors_at(const LogProblem& problem, const SearchPoint& point);
std::vector<WindowSums> sums_at(const LogProblem& problem, const SearchPoint& point,
                                double block_s = 0.0);

double change_cost_of(const std::vector<WindowErrors>& errors);

std::vector<double> change_times_of(const std::vector<WindowErrors>& errors);

bool all_finite(const std::vector<WindowErrors>& errors);
bool all_finite(const std::vector<WindowSums>& sums);

/// Number of windows (10 s each) in the sample with which the fit of long logs starts, to save
/// time. Logs with less than twice as many windows are used entirely.
inline constexpr std::size_t kSampleWindows = 12;

/// True if the logs have at least 2 kSampleWindows windows, so that a sample of them saves time.
bool is_long(const LogProblem& problem);

/// Returns `count` evenly spaced indices out of `size`, or all indices if there are fewer.
std::vector<std::size_t> spread(std::size_t size, std::size_t count);

/// Returns the problem with only these windows (indices). Leaves out sensors without samples in
/// them.
LogProblem with_windows(const LogProblem& problem, const std::vector<std::size_t>& windows);

/// Returns the point with only the initial states of these windows (indices). `problem`: problem to
/// which `point` belongs.
SearchPoint with_windows(const LogProblem& problem, const SearchPoint& point,
                         const std::vector<std::size_t>& windows);

/// Result of solve().
struct Solved {
  SearchPoint point;  ///< point where the search ended, converged or not
  double cost = std::numeric_limits<double>::infinity();
  bool converged = false;
  bool usable = false;  ///< true: the solver did not fail and did not increase the cost
  std::string stop_reason;
};

/// Minimises the cost by Levenberg-Marquardt steps within the bounds, starting at `from`. Each step
/// eliminates the initial states of the windows from its linear system. The search converges when a
/// step changes the cost by less than the fraction `function_tolerance` of the cost, or when
/// further steps would not help (EndWithoutProgress in ceres_problem.cpp). It ends without
/// convergence after 60 steps, at the limit of work (Effort) or at the deadline.
Solved solve(const LogProblem& problem, SearchPoint from, double function_tolerance);

/// Largest absolute value that was measured of a channel; 1 if nothing was measured.
double fastest_of(const LogProblem& problem, LogChannel channel);

}  // namespace awmr
