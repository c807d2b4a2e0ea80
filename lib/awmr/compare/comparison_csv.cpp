// Writes the text of comparison.csv.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "awmr/compare/compare.h"
#include "awmr/compare/metric_columns.h"
#include "awmr/core/csv.h"
#include "awmr/core/csv_cell.h"

namespace awmr {

std::vector<std::pair<std::string_view, std::optional<double>>> named_metrics(
    const Metrics& metrics) {
  std::vector<std::pair<std::string_view, std::optional<double>>> named;
  for (const MetricColumn& metric : kMetricColumns) {
    named.emplace_back(metric.name, metric.value(metrics));
  }
  return named;
}

std::vector<std::string> comparison_columns(bool with_gains) {
  std::vector<std::string> names{"scenario", "mode", "sample", "completed"};
  for (const MetricColumn& metric : kMetricColumns) names.emplace_back(metric.name);
  if (with_gains) names.emplace_back("gains");
  return names;
}

std::string comparison_csv(const Comparison& comparison) {
  const bool several = std::any_of(comparison.rows.begin(), comparison.rows.end(),
                                   [](const ComparisonRow& row) { return !row.gains.empty(); });
  std::string text = fmt::format("{}\n", fmt::join(comparison_columns(several), ","));
  for (const ComparisonRow& row : comparison.rows) {
    text += cell_of_text(row.scenario);
    text += ',';
    text += name_of(row.mode);
    text += ',' + std::to_string(row.sample) + (row.metrics.completed ? ",1" : ",0");
    for (const MetricColumn& metric : kMetricColumns) {
      text += ',';
      if (const auto value = metric.value(row.metrics)) text += format_number(*value);
    }
    if (several) text += ',' + cell_of_text(row.gains);
    text += '\n';
  }
  return text;
}

}  // namespace awmr
