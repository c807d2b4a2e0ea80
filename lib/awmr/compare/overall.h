/// Summary over all scenarios: the number of scenarios in which each mode is best in a metric, and
/// in which the ranking is decided. Private to compare/.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "awmr/compare/decision.h"
#include "awmr/compare/preferences.h"
#include "awmr/compare/ranking.h"
#include "awmr/compare/statistics.h"

namespace awmr {

/// For one metric: the number of scenarios in which each contender is best or tied with the best.
struct MetricTally {
  MetricId metric{};
  int scenarios = 0;              ///< number of ranked scenarios in which any mode has the metric
  std::vector<int> best_or_tied;  ///< by contender, in the order of ScenarioRows::modes
};

/// A scenario with its statistics, ranking and verdict.
struct EvaluatedScenario {
  ScenarioRows rows;
  std::vector<PairedDifference> differences;
  std::vector<RankedMode> ranking;
  std::optional<Decision> decision;  ///< absent without a ranking, or with a single mode
  std::string verdict;
};

/// Evaluates each scenario. `comparison` must be a result of evaluated_part(), and must outlive the
/// returned value.
std::vector<EvaluatedScenario> evaluate_scenarios(const Comparison& comparison,
                                                  const Preferences& preferences,
                                                  std::uint64_t seed);
/// Returns the scenarios that have a ranking.
std::vector<EvaluatedScenario> ranked_of(const std::vector<EvaluatedScenario>& scenarios);

/// Returns for each scenario the index of the first scenario with identical runs (all metrics of
/// all modes and samples are equal), which is its own index if no earlier one has them. Summaries
/// count only the first of identical scenarios.
std::vector<std::size_t> first_with_same_runs(const std::vector<EvaluatedScenario>& scenarios);

/// For each metric that can be used to rank modes, counts for each contender the scenarios in which
/// no other contender is better. Another one is better if its mean is lower by a relevant
/// difference, or if only it has a value. Scenarios with identical runs count once. `scenarios`:
/// those with a ranking.
std::vector<MetricTally> tally(const std::vector<EvaluatedScenario>& scenarios);

/// Number of scenarios with each kind of decision, and number of scenarios whose rank 1 survives
/// all changes of a kind (Decision::survives()). Scenarios with identical runs count once.
struct DecisionTally {
  std::map<DecisionKind, int> scenarios;
  struct Share {
    int count = 0;  ///< scenarios in which, under each such change, a mode of rank 1 keeps rank 1
    int of = 0;     ///< scenarios with a change of this kind
  };
  std::map<ChangeKind, Share> survived;
};
DecisionTally tally_decisions(const std::vector<EvaluatedScenario>& scenarios);

}  // namespace awmr
