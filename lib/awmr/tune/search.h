/// The search over the gains' logarithms: feasibility, a global search, a local one. Private to
/// tune/.
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
  Candidate nearest;              ///< the best of all by better()
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

/// LN_COBYLA from `start`, then again and again from the best point that `problem` has met, each
/// time with the first step anew, until a search gains less than 1e-4 or the budget is spent.
/// Returns why it stopped. Errors (program fault): NLopt's.
Result<std::string> search_locally(Problem& problem, const Gains<double>& start,
                                   int most_evaluations);

/// Gains within the bounds that meet `context`, or those that come nearest: no simulation is
/// needed.
Candidate feasible_start(const TuneOptions& options, const ConstraintContext& context,
                         const Gains<double>& baseline);

/// On `searched`: GN_ISRES from the first of `starts`, then LN_COBYLA from the best point met, the
/// other starts among them, over ln(gains); if that finds no feasible gains, from each of the
/// starts as well. Then, where `all` has more draws, LN_COBYLA on them from there. All starts meet
/// the constraints that need no run; there is at least one. Each point is kept only if it meets
/// every constraint exactly, whatever tolerance the search itself works with. Deterministic:
/// NLopt's generator is reseeded, and searches in one process take turns.
Result<SearchResult> search(const TuneOptions& options, const ConstraintContext& context,
                            const Objective& searched, const Objective& all,
                            std::span<const Gains<double>> starts);

}  // namespace awmr
