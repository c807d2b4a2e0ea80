/// Which mode is best for what, over all scenarios. Private to this folder.
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

/// In how many scenarios each contender was the best in one metric, or not distinguishable from it.
struct MetricTally {
  MetricId metric{};
  int scenarios = 0;              ///< that were ranked and have the metric in some mode
  std::vector<int> best_or_tied;  ///< by contender, as ScenarioRows::modes
};

/// One scenario with its results.
struct EvaluatedScenario {
  ScenarioRows rows;
  std::vector<PairedDifference> differences;
  std::vector<RankedMode> ranking;
  std::optional<Decision> decision;  ///< absent where nothing is ranked, or there is one mode only
  std::string verdict;
};

/// `comparison` is an evaluated_part(), and outlives the result, which looks at its rows.
std::vector<EvaluatedScenario> judge(const Comparison& comparison, const Preferences& preferences,
                                     std::uint64_t seed);
/// Ranked scenarios.
std::vector<EvaluatedScenario> ranked_of(const std::vector<EvaluatedScenario>& scenarios);

/// By position: the first scenario of the list with the same runs, every figure of every mode and
/// sample equal; itself where there is none before it. Two files of one course are one course.
std::vector<std::size_t> first_with_same_runs(const std::vector<EvaluatedScenario>& scenarios);

/// By metric that can rank, over the scenarios given: those that are ranked, of several with the
/// same runs the first. A contender is beaten in a metric by one whose mean is lower where the
/// difference is a relevant one. A contender without a value is beaten by any that has one.
std::vector<MetricTally> tally(const std::vector<EvaluatedScenario>& scenarios);

/// Number of scenarios with each kind of decision, and of those whose first place survives each
/// kind of change in all of its settings. Scenarios with the same runs count once.
struct DecisionTally {
  std::map<DecisionKind, int> scenarios;
  struct Share {
    int count = 0;  ///< that survive
    int of = 0;     ///< that have such a change
  };
  std::map<ChangeKind, Share> survived;
};
DecisionTally tally_decisions(const std::vector<EvaluatedScenario>& scenarios);

}  // namespace awmr
