/// Searches from several initial guesses (multistart), which find starting points for a log fit.
/// Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/problem/log_problem.h"
#include "awmr/model/record.h"

namespace awmr {

/// Result of multistart().
struct Multistart {
  /// Coordinates where the usable searches ended, smallest cost first.
  std::vector<std::vector<double>> ends;
  /// Report of every search: from the initial guess, from LogFitOptions::also_from, from random
  /// guesses.
  std::vector<SearchStart> starts;
  /// LogFit::relative_error at the first element of `ends`, in the parts of the logs that the
  /// searches use. 0 without a search.
  double relative_error = 0.0;
  int readings = 0;  ///< number of readings in these parts
};

/// True if a complete fit of a model would waste time, because its quick searches, compared with
/// those of the best fit so far, show that it will not be selected. `search` must be usable. One of
/// these conditions suffices:
///   - -2 ln L is higher by more than 100 than that of the best fit after its quick searches. It is
///     computed with noise levels at which the best fit so far has no model error.
///   - The errors of the best fit have a large drift, so that it gets no intervals, and this model
///     does not reduce its mean square error beyond that of the sensor noise by 30 %. (In this case
///     both models are wrong, and AIC cannot decide between two wrong models.)
///   - The model is selected only with a much lower AIC (BestSoFar::needs_large_gain), but -2 ln L
///     of its quick searches is lower by less than 5.
bool is_far_worse(const Multistart& search, const BestSoFar& best);

/// Returns a smaller problem for quick searches: up to twelve parts of at most 2.5 s (or 50 rows,
/// if they last longer), spread over all logs, with longer integration steps.
LogProblem rough_problem(const LogProblem& problem);

/// A quick search ends when a step changes the cost by less than this fraction of the cost. It only
/// has to find a starting point.
inline constexpr double kRough = 1e-4;

/// Finds initial guesses for the fit. If other trials gave the whole initial guess and `also_from`
/// is empty, returns only that guess, without a search.
///
/// In all other cases, runs quick searches from the initial guess and from each guess in
/// `also_from`. If the guess of some parameters is only an order of magnitude, also searches from
/// random guesses. The searches use short parts of some windows: over a long part, the effect of a
/// wrong guess accumulates, and the search ends in a wrong optimum. If no search is usable, `ends`
/// is empty.
Multistart multistart(const LogProblem& problem, const LogFitOptions& options);

}  // namespace awmr
