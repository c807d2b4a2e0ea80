/// Summary over all scenarios: for each metric, in how many scenarios each mode is best; and in how
/// many scenarios the ranking is decided. Private to compare/.
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
  const MetricColumn* metric = nullptr;  ///< an entry of kMetricColumns
  int scenarios = 0;              ///< number of ranked scenarios in which any mode has the metric
  std::vector<int> best_or_tied;  ///< counts by contender, in the order of ScenarioRows::modes
};

/// A scenario with its statistics, ranking and verdict.
struct EvaluatedScenario {
  ScenarioRows rows;
  std::vector<PairedDifference> differences;
  std::vector<RankedMode> ranking;
  std::optional<Decision> decision;  ///< absent without a ranking, or if there is a single mode
  std::string verdict;
};

/// `comparison`: a result of evaluated_part(); it must outlive the returned value.
std::vector<EvaluatedScenario> evaluate_scenarios(const Comparison& comparison,
                                                  const Preferences& preferences,
                                                  std::uint64_t seed);
std::vector<EvaluatedScenario> ranked_of(const std::vector<EvaluatedScenario>& scenarios);

/// Finds scenarios with identical runs, in which all metrics of all modes and samples are equal.
/// Returns for each scenario the index of the first scenario with the same runs, or its own index.
/// Summaries count only this first scenario.
std::vector<std::size_t> first_with_same_runs(const std::vector<EvaluatedScenario>& scenarios);

/// For each metric that can be used to rank modes, counts the scenarios in which no other contender
/// (a mode with its gains) is better. A contender is better if its mean is lower by a relevant
/// difference, or if only it has a value. Scenarios with identical runs count once. `scenarios`:
/// scenarios with a ranking.
std::vector<MetricTally> tally(const std::vector<EvaluatedScenario>& scenarios);

/// Number of scenarios with each kind of decision and, for each kind of change, number of scenarios
/// in which the ranking survives (Decision::survives()). Scenarios with identical runs count once.
struct DecisionTally {
  std::map<DecisionKind, int> scenarios;
  struct Share {
    /// Scenarios in which a mode of rank 1 keeps this rank under each change of this kind.
    int count = 0;
    int of = 0;  ///< scenarios with any change of this kind
  };
  std::map<ChangeKind, Share> survived;
};
DecisionTally tally_decisions(const std::vector<EvaluatedScenario>& scenarios);

}  // namespace awmr
