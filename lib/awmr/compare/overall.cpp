#include "awmr/compare/overall.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace awmr {
namespace {

/// True if `other` is better than `own` in the metric: its value is relevantly lower
/// (Conclusion::kRelevant), or only `other` has a value. If only one of the modes completes any
/// run, this mode is better.
bool beats(const EvaluatedScenario& scenario, const MetricColumn& metric, const ModeRows& other,
           const ModeRows& own) {
  const bool own_completes = own.completed_count() > 0;
  if (own_completes != (other.completed_count() > 0)) return !own_completes;
  const auto theirs = summarise(other, metric).mean;
  const auto mine = summarise(own, metric).mean;
  if (!theirs || !mine) return theirs.has_value() && !mine;
  if (!(*theirs < *mine)) return false;
  return std::any_of(scenario.differences.begin(), scenario.differences.end(),
                     [&](const PairedDifference& d) {
                       return d.metric == &metric && d.conclusion == Conclusion::kRelevant &&
                              d.is_between(own.contender, other.contender);
                     });
}

bool same_runs(const ModeRows& a, const ModeRows& b) {
  if (!(a.contender == b.contender)) return false;
  return std::equal(a.rows.begin(), a.rows.end(), b.rows.begin(), b.rows.end(),
                    [](const ComparisonRow& one, const ComparisonRow& other) {
                      return one.metrics.completed == other.metrics.completed &&
                             std::all_of(kMetricColumns.begin(), kMetricColumns.end(),
                                         [&](const MetricColumn& metric) {
                                           return metric.value(one.metrics) ==
                                                  metric.value(other.metrics);
                                         });
                    });
}

}  // namespace

std::vector<EvaluatedScenario> evaluate_scenarios(const Comparison& comparison,
                                                  const Preferences& preferences,
                                                  std::uint64_t seed) {
  std::vector<EvaluatedScenario> all;
  for (ScenarioRows& scenario : group(comparison)) {
    ScenarioStatistics statistics = statistics_of(scenario, preferences, seed);
    auto ranking = rank(scenario, statistics, preferences, seed);
    std::optional<Decision> decision;
    if (ranking.size() > 1) {
      decision = decide(scenario, statistics, ranking, comparison.changes, preferences, seed);
    }
    std::string verdict =
        verdict_of(scenario, ranking, decision, statistics.differences, preferences);
    all.push_back({std::move(scenario), std::move(statistics.differences), std::move(ranking),
                   std::move(decision), std::move(verdict)});
  }
  return all;
}

std::vector<EvaluatedScenario> ranked_of(const std::vector<EvaluatedScenario>& scenarios) {
  std::vector<EvaluatedScenario> ranked;
  std::copy_if(scenarios.begin(), scenarios.end(), std::back_inserter(ranked),
               [](const EvaluatedScenario& scenario) { return !scenario.ranking.empty(); });
  return ranked;
}

std::vector<std::size_t> first_with_same_runs(const std::vector<EvaluatedScenario>& scenarios) {
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    const std::vector<ModeRows>& modes = scenarios[i].rows.modes;
    std::size_t twin = 0;
    while (twin < i && !std::equal(modes.begin(), modes.end(), scenarios[twin].rows.modes.begin(),
                                   scenarios[twin].rows.modes.end(), same_runs)) {
      ++twin;
    }
    first.push_back(twin);
  }
  return first;
}

std::vector<MetricTally> tally(const std::vector<EvaluatedScenario>& scenarios) {
  std::vector<MetricTally> tallies;
  if (scenarios.empty()) return tallies;
  const std::size_t contenders = scenarios.front().rows.modes.size();
  const std::vector<std::size_t> first = first_with_same_runs(scenarios);
  for (const MetricColumn& metric : kMetricColumns) {
    if (!metric.can_rank()) continue;
    MetricTally one{&metric, 0, std::vector<int>(contenders, 0)};
    for (std::size_t s = 0; s < scenarios.size(); ++s) {
      const EvaluatedScenario& scenario = scenarios[s];
      if (first[s] != s || !any_has(scenario.rows, metric)) continue;
      ++one.scenarios;
      const std::vector<ModeRows>& modes = scenario.rows.modes;
      for (std::size_t i = 0; i < contenders; ++i) {
        const bool beaten = std::any_of(modes.begin(), modes.end(), [&](const ModeRows& other) {
          return &other != &modes[i] && beats(scenario, metric, other, modes[i]);
        });
        one.best_or_tied[i] += beaten ? 0 : 1;
      }
    }
    if (one.scenarios > 0) tallies.push_back(std::move(one));
  }
  return tallies;
}

DecisionTally tally_decisions(const std::vector<EvaluatedScenario>& scenarios) {
  DecisionTally tally;
  const std::vector<std::size_t> first = first_with_same_runs(scenarios);
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    const std::optional<Decision>& decision = scenarios[i].decision;
    if (first[i] != i || !decision) continue;
    ++tally.scenarios[decision->kind()];
    for (const auto& [name, kind] : kChangeKindNames) {
      bool has_one = false;
      bool survives = true;
      for (const Change& change : decision->changes) {
        if (change.kind != kind) continue;
        has_one = true;
        survives = survives && decision->survives(change);
      }
      tally.survived[kind].of += has_one ? 1 : 0;
      tally.survived[kind].count += has_one && survives ? 1 : 0;
    }
  }
  return tally;
}

}  // namespace awmr
