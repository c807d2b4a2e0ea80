/// Search over the logarithms of the gains: feasibility, then global, then local. Private to tune/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/tune.h"

namespace awmr {

struct SearchResult {
  std::optional<Candidate> best;  ///< the best feasible one, if any was met
  Candidate nearest;              ///< the first in the order of better()
  /// Without a best: the constraint that the nearest candidate violates most, and the violation as
  /// a fraction of the larger of the constraint's two sides.
  std::string broken_most = {};
  double broken_by = 0.0;
  int evaluations = 0;
  int simulated = 0;
  SearchHistory history;
  std::vector<TradeOffPoint> met;  ///< of all feasible gains on the searched draws
  std::string algorithm;
  std::string stop_reason;
};

/// Runs LN_COBYLA from `start`, then repeatedly from the best point of `problem`, each time with
/// the initial step size, until an improvement is below 1e-4 or the budget is spent. Returns the
/// reason for stopping. Errors (program fault): NLopt's.
Result<std::string> search_locally(Problem& problem, const Gains<double>& start,
                                   int most_evaluations);

/// Returns gains within the bounds that meet `context`, or those with the smallest violation. Needs
/// no simulation.
Candidate feasible_start(const TuneOptions& options, const ConstraintContext& context,
                         const Gains<double>& baseline);

/// Searches ln(gains) in this order:
///   1. on `searched`: GN_ISRES from the first of `starts`;
///   2. LN_COBYLA from the best point so far, including the other starts;
///   3. without feasible gains, LN_COBYLA from each start;
///   4. if `all` has more draws, LN_COBYLA on `all` from the best point.
/// Precondition: at least one start; all meet the constraints that need no run. The result meets
/// every constraint exactly, whatever the tolerance of NLopt. Deterministic:
/// NLopt's generator is reseeded, and searches in one process take turns.
Result<SearchResult> search(const TuneOptions& options, const ConstraintContext& context,
                            const Objective& searched, const Objective& all,
                            std::span<const Gains<double>> starts);

}  // namespace awmr
