#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "awmr/compare/break_even.h"
#include "awmr/compare/overall.h"
#include "awmr/compare/ranking.h"
#include "awmr/compare/statistics.h"
#include "awmr/core/text.h"

namespace awmr {
namespace {

/// Formats a metric in at most 7 characters, for values below 10^7.
std::string figure(double value) {
  return fmt::format("{:.{}f}", value, std::abs(value) < 100.0 ? 3 : std::abs(value) < 1e4 ? 1 : 0);
}

/// Rank of a contender: "1", "2=" for a tie, "-" without a ranking.
std::string place_of(const Contender& contender, const std::vector<RankedMode>& ranking) {
  for (const RankedMode& ranked : ranking) {
    if (ranked.contender == contender) {
      return fmt::format("{}{}", ranked.rank, ranked.tied_with.empty() ? "" : "=");
    }
  }
  return "-";
}

/// Notes on metrics that some runs lack: "  settle: mean of some runs: steering 3 of 8".
std::string partial_means(const ScenarioRows& scenario) {
  std::string text;
  for (const MetricColumn& metric : kMetricColumns) {
    if (metric.head.empty()) continue;
    std::string counts;
    for (const ModeRows& rows : scenario.modes) {
      const std::size_t count = summarise(rows, metric).count;
      if (count == 0 || count == rows.counted().size()) continue;
      counts += fmt::format("{}{} {} of {}", counts.empty() ? "" : ", ", rows.label(), count,
                            rows.counted().size());
    }
    if (!counts.empty()) text += fmt::format("  {}: mean of some runs: {}\n", metric.head, counts);
  }
  return text;
}

/// Table of one scenario: a line for each mode, and a column for each metric that any mode has.
std::string table_of(const ScenarioRows& scenario, const std::vector<RankedMode>& ranking) {
  std::size_t width = 12;
  for (const ModeRows& rows : scenario.modes) width = std::max(width, rows.label().size());
  std::string head = fmt::format("  {:<{}} {:>4}", "mode", width, "done");
  std::string units = fmt::format("  {:<{}} {:>4}", "", width, "%");
  std::vector<std::string> lines;
  for (const ModeRows& rows : scenario.modes) {
    lines.push_back(
        fmt::format("  {:<{}} {:>4.0f}", rows.label(), width, 100.0 * rows.completed_share()));
  }
  for (const MetricColumn& metric : kMetricColumns) {
    if (metric.head.empty() || !any_has(scenario, metric)) continue;
    head += fmt::format(" {:>7}", metric.head);
    units += fmt::format(" {:>7}", metric.unit);
    for (std::size_t mode = 0; mode < lines.size(); ++mode) {
      const auto mean = summarise(scenario.modes[mode], metric).mean;
      lines[mode] += fmt::format(" {:>7}", mean ? figure(*mean) : "-");
    }
  }
  std::string text = head + " rank\n" + units + '\n';
  for (std::size_t mode = 0; mode < lines.size(); ++mode) {
    text +=
        fmt::format("{} {:>4}\n", lines[mode], place_of(scenario.modes[mode].contender, ranking));
  }
  return text + partial_means(scenario);
}

/// Text such as "first place under every change: one mode in 3 scenarios, several modes in 0,
/// undecided in 2; survives a change of plant in 3 of 5, ...".
std::string decisions_of(const std::vector<EvaluatedScenario>& scenarios) {
  DecisionTally tally = tally_decisions(scenarios);
  std::string text = fmt::format(
      "first place under every change: one mode in {} scenarios, several modes in {}, undecided in "
      "{}",
      tally.scenarios[DecisionKind::kDecided], tally.scenarios[DecisionKind::kLevel],
      tally.scenarios[DecisionKind::kUndecided]);
  std::string survived;
  for (const auto& [name, kind] : kChangeKindNames) {
    const DecisionTally::Share& share = tally.survived[kind];
    if (share.of == 0) continue;
    survived += fmt::format("{}{} in {} of {}", survived.empty() ? "; survives a change of " : ", ",
                            name, share.count, share.of);
  }
  return text + survived + '\n';
}

/// Table by metric: in how many scenarios each mode is best or tied. Empty for a single scenario.
std::string overall_of(const std::vector<EvaluatedScenario>& scenarios) {
  if (scenarios.size() < 2) return "";
  std::string text =
      fmt::format("best or tied with the best, by metric\n  {:<20} {:>9}", "", "scenarios");
  for (const ModeRows& rows : scenarios.front().rows.modes) {
    text += fmt::format(" {:>12}", rows.label());
  }
  text += '\n';
  for (const MetricTally& one : tally(scenarios)) {
    if (one.metric->head.empty()) continue;
    text += fmt::format("  {:<20} {:>9}", one.metric->name, one.scenarios);
    for (std::size_t i = 0; i < one.best_or_tied.size(); ++i) {
      const std::size_t width =
          std::max<std::size_t>(12, scenarios.front().rows.modes[i].label().size());
      text += fmt::format(" {:>{}}", one.best_or_tied[i], width);
    }
    text += '\n';
  }
  text += decisions_of(scenarios);
  const std::vector<std::size_t> first = first_with_same_runs(scenarios);
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    if (first[i] == i) continue;
    text += paragraph(fmt::format("counted once: '{}' has the same runs as '{}'",
                                  scenarios[i].rows.scenario, scenarios[first[i]].rows.scenario),
                      2);
  }
  return text;
}

}  // namespace

std::string comparison_table(const Comparison& comparison, const CompareOptions& options) {
  std::string text;
  const Comparison part = evaluated_part(comparison);
  const std::vector<EvaluatedScenario> scenarios =
      evaluate_scenarios(part, options.preferences, options.seed);
  for (const EvaluatedScenario& scenario : scenarios) {
    const std::size_t samples = scenario.rows.modes.front().rows.size() - 1;
    text += fmt::format(
        "{}: {}\n", scenario.rows.scenario,
        samples == 0 ? "the model's own values" : fmt::format("mean of {} sample(s)", samples));
    text += table_of(scenario.rows, scenario.ranking);
    text += paragraph(scenario.verdict, 2);
  }
  text += overall_of(ranked_of(scenarios));
  if (comparison.break_even) text += break_even_table(*comparison.break_even);
  return text;
}

}  // namespace awmr
