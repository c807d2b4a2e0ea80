/// Best mode by metric over all scenarios. Private to this folder.
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

/// Number of scenarios in which each contender was best in one metric, or tied with the best.
struct MetricTally {
  MetricId metric{};
  int scenarios = 0;              ///< number of ranked scenarios with the metric in any mode
  std::vector<int> best_or_tied;  ///< by contender, as ScenarioRows::modes
};

/// One scenario with its results.
struct EvaluatedScenario {
  ScenarioRows rows;
  std::vector<PairedDifference> differences;
  std::vector<RankedMode> ranking;
  std::optional<Decision> decision;  ///< absent without a ranking, or with a single mode
  std::string verdict;
};

/// `comparison`: an evaluated_part(), which must outlive the result.
std::vector<EvaluatedScenario> evaluate_scenarios(const Comparison& comparison,
                                                  const Preferences& preferences,
                                                  std::uint64_t seed);
/// Ranked scenarios.
std::vector<EvaluatedScenario> ranked_of(const std::vector<EvaluatedScenario>& scenarios);

/// By position: index of the first scenario with identical runs (all metrics of all modes and
/// samples are equal), which can be itself. Duplicate scenarios count once.
std::vector<std::size_t> first_with_same_runs(const std::vector<EvaluatedScenario>& scenarios);

/// By ranking metric, over the ranked scenarios; of scenarios with identical runs only the first. A
/// contender is worse than another in a metric if the mean is higher by a relevant difference, or
/// if only the other has a value.
std::vector<MetricTally> tally(const std::vector<EvaluatedScenario>& scenarios);

/// Number of scenarios with each kind of decision, and number of those whose rank 1 holds under all
/// changes of a kind. Scenarios with identical runs count once.
struct DecisionTally {
  std::map<DecisionKind, int> scenarios;
  struct Share {
    int count = 0;  ///< number in which rank 1 holds
    int of = 0;     ///< number with such a change
  };
  std::map<ChangeKind, Share> survived;
};
DecisionTally tally_decisions(const std::vector<EvaluatedScenario>& scenarios);

}  // namespace awmr
