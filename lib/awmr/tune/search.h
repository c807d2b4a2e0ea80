/// Search over the logarithms of the gains: a global, then a local search of the
/// objective. Private to tune/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/tune.h"

namespace awmr {

struct SearchResult {
  Candidate nearest;  ///< the best candidate in the order of better(), feasible or not
  /// If `nearest` is not feasible: the constraint that it violates most, and its residual
  /// (Looked::residuals).
  std::string broken_most = {};
  double broken_by = 0.0;
  int evaluations = 0;  ///< evaluated sets of gains, on some or all drawn vehicles
  int simulated = 0;    ///< number of evaluated sets whose runs were simulated
  SearchHistory history;
  /// All feasible gains, with their settling time and control variation on the drawn vehicles of
  /// the search.
  std::vector<FrontPoint> met;
  std::string algorithm;
  std::string stop_reason;
};

/// Runs local searches in parallel from two starts, the best point of `problem` and gains with
/// slower poles, with half of `most_evaluations` each. The second start is needed because the best
/// point often lies where several constraints meet. COBYLA, whose models of the constraints are
/// linear, can fail to move from there. Returns the reasons for stopping. Errors (program fault): a
/// failure of NLopt.
Result<std::string> search_near(Problem& problem, int most_evaluations);

/// Searches the logarithms of the gains with NLopt. `searched` is the objective on the nominal
/// vehicle and some of the drawn vehicles, `all` on the nominal vehicle and all drawn vehicles.
///   1. GN_ISRES on `searched` from the first of `starts`;
///   2. search_near() on `searched` from the best point so far, including the other starts;
///   3. if there are no feasible gains yet, LN_COBYLA on `searched` from each start;
///   4. if `all` has more vehicles, LN_COBYLA on `all` from the best point, including the starts.
/// Precondition: at least one start; all starts meet the constraints that need no simulation.
/// If SearchResult::nearest is feasible, it meets every constraint exactly, whatever NLopt's
/// tolerance. Deterministic: NLopt's random generator is reseeded, and global searches in one
/// process take turns. Errors (program fault): a failure of NLopt.
Result<SearchResult> search(const TuneOptions& options, const ConstraintContext& context,
                            const Objective& searched, const Objective& all,
                            std::span<const Gains<double>> starts);

}  // namespace awmr
