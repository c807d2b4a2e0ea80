/// The search over the gains' logarithms: feasibility, a global search, a local one. Private to
/// tune/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Gains that were looked at.
struct Candidate {
  Gains<double> gains{};
  /// Largest residual of the constraints and of "no mode is worse than the baseline"; <= 0 is
  /// feasible.
  double violation = 0.0;
  double objective = 0.0;  ///< meaningful where `simulated`
  bool simulated = false;  ///< false: a constraint was broken, so nothing was run
  bool valid = false;      ///< finite, and completes what the baseline completes

  bool feasible() const { return simulated && valid && violation <= 0.0; }
};

/// The order of candidates: any feasible one before any other; feasible ones by their objective,
/// the others by their violation.
bool better(const Candidate& a, const Candidate& b);

struct SearchResult {
  std::optional<Candidate> best;  ///< the best feasible one, if any was met
  Candidate nearest;              ///< the best of all by better()
  int evaluations = 0;
  int simulated = 0;
  SearchHistory history;
  std::string algorithm;
  std::string stop_reason;
};

/// Gains within the bounds that meet `context`, or those that come nearest: no simulation is
/// needed.
Candidate feasible_start(const TuneOptions& options, const ConstraintContext& context,
                         const Gains<double>& baseline);

/// GN_ISRES from `start` (feasible), then LN_COBYLA from the best point met, over ln(gains). Each
/// point is kept only if it meets every constraint exactly, whatever tolerance the search itself
/// works with. Deterministic: NLopt's generator is reseeded, and searches in one process take
/// turns.
Result<SearchResult> search(const TuneOptions& options, const ConstraintContext& context,
                            const Objective& objective, const Gains<double>& start);

}  // namespace awmr
