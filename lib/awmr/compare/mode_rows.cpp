#include "awmr/compare/mode_rows.h"

#include <algorithm>

#include "awmr/core/index.h"

namespace awmr {
namespace {

Contender contender_of(const ComparisonRow& row) { return {row.mode, row.gains}; }

}  // namespace

std::size_t ModeRows::completed_count() const {
  const auto runs = counted();
  return at(std::count_if(runs.begin(), runs.end(),
                          [](const ComparisonRow& row) { return row.metrics.completed; }));
}

double ModeRows::completed_share() const {
  return static_cast<double>(completed_count()) / static_cast<double>(counted().size());
}

std::string Contender::label() const {
  const std::string name(name_of(mode));
  return gains.empty() ? name : name + " with " + gains;
}

Comparison evaluated_part(const Comparison& comparison) {
  Comparison part{.rows = {},
                  .whole_samples = comparison.whole_samples,
                  .stopped = comparison.stopped,
                  .arithmetic = comparison.arithmetic,
                  .changes = comparison.changes};
  for (const ComparisonRow& row : comparison.rows) {
    if (row.sample < comparison.whole_samples) part.rows.push_back(row);
  }
  return part;
}

std::vector<ScenarioRows> group(const Comparison& comparison) {
  std::vector<ScenarioRows> scenarios;
  const std::span<const ComparisonRow> rows = comparison.rows;
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin;
    while (end < rows.size() && rows[end].scenario == rows[begin].scenario &&
           contender_of(rows[end]) == contender_of(rows[begin])) {
      ++end;
    }
    if (scenarios.empty() || scenarios.back().scenario != rows[begin].scenario) {
      scenarios.push_back({rows[begin].scenario, {}});
    }
    scenarios.back().modes.push_back({contender_of(rows[begin]), rows.subspan(begin, end - begin)});
    begin = end;
  }
  return scenarios;
}

}  // namespace awmr
