/// Which mode is best for what, over all scenarios. Private to this folder.
#pragma once

#include <vector>

#include "awmr/compare/statistics.h"

namespace awmr {

/// In how many scenarios each contender was the best in one metric, or not told apart from it.
struct MetricTally {
  MetricId metric{};
  int scenarios = 0;              ///< that were ranked and have the metric in some mode
  std::vector<int> best_or_tied;  ///< by contender, as ScenarioRows::modes
};

/// One scenario with its differences.
struct JudgedScenario {
  const ScenarioRows* rows = nullptr;
  const std::vector<PairedDifference>* differences = nullptr;
};

/// By position: the first scenario of the list with the same runs, every figure of every mode and
/// sample equal; itself where there is none before it. Two files of one course are one course.
std::vector<std::size_t> first_with_same_runs(const std::vector<JudgedScenario>& scenarios);

/// By ranked metric, over the scenarios given: those that are ranked, of several with the same runs
/// the first. A contender is beaten in a
/// metric by one whose mean is lower: with samples where Holm's p says so, without where it is by
/// more than 1 % of the metric's scale. A contender without a value is beaten by any that has one.
std::vector<MetricTally> tally(const std::vector<JudgedScenario>& scenarios);

}  // namespace awmr
