/// Summary over all scenarios: how often each mode is best in a metric, and how many rankings are
/// decided. Private to compare/.
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
  int scenarios = 0;              ///< number of ranked scenarios in which a mode has the metric
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

/// Evaluates each scenario. `comparison` is an evaluated_part() and must outlive the result.
std::vector<EvaluatedScenario> evaluate_scenarios(const Comparison& comparison,
                                                  const Preferences& preferences,
                                                  std::uint64_t seed);
/// Returns the scenarios that have a ranking.
std::vector<EvaluatedScenario> ranked_of(const std::vector<EvaluatedScenario>& scenarios);

/// For each scenario, the index of the first scenario with identical runs (all metrics of all modes
/// and samples are equal); its own index if there is none before it. Summaries count only these
/// first scenarios.
std::vector<std::size_t> first_with_same_runs(const std::vector<EvaluatedScenario>& scenarios);

/// Counts for each metric that can rank, over the ranked scenarios; scenarios with identical runs
/// count once. A contender is worse than another in a metric if its mean is higher by a relevant
/// difference, or if only the other has a value.
std::vector<MetricTally> tally(const std::vector<EvaluatedScenario>& scenarios);

/// Number of scenarios with each kind of decision, and number of scenarios in which a mode keeps
/// rank 1 under all changes of a kind. Scenarios with identical runs count once.
struct DecisionTally {
  std::map<DecisionKind, int> scenarios;
  struct Share {
    int count = 0;  ///< scenarios in which a mode keeps rank 1
    int of = 0;     ///< scenarios with a change of this kind
  };
  std::map<ChangeKind, Share> survived;
};
DecisionTally tally_decisions(const std::vector<EvaluatedScenario>& scenarios);

}  // namespace awmr
