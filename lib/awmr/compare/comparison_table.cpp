#include <fmt/format.h>

#include <array>
#include <cmath>

#include "awmr/compare/ranking.h"
#include "awmr/compare/statistics.h"

namespace awmr {
namespace {

/// Short heads of the metrics' columns, in their order.
constexpr std::array<const char*, kMetricColumns.size()> kHeads = {
    "settle", "overs.", "IAE", "x-track", "path", "drop", "slip", "yaw", "var.", "clear", "finish"};

/// At most 7 characters up to 10^7.
std::string figure(double value) {
  return fmt::format("{:.{}f}", value, std::abs(value) < 100.0 ? 3 : std::abs(value) < 1e4 ? 1 : 0);
}

std::string row_text(const ModeRows& rows, const std::vector<RankedMode>& ranking) {
  std::string text =
      fmt::format("  {:<12} {:>4.0f}", name_of(rows.mode), 100.0 * rows.completed_share());
  for (const MetricColumn& metric : kMetricColumns) {
    const auto mean = summarise(rows, metric).mean;
    text += fmt::format(" {:>7}", mean ? figure(*mean) : "-");
  }
  std::string place = "-";
  for (const RankedMode& ranked : ranking) {
    if (ranked.mode != rows.mode) continue;
    place = fmt::format("{}{}", ranked.rank, ranked.tied_with.empty() ? "" : "=");
  }
  return text + fmt::format(" {:>4}\n", place);
}

}  // namespace

std::string comparison_table(const Comparison& comparison) {
  std::string head = fmt::format("  {:<12} {:>4}", "mode", "done");
  std::string units = fmt::format("  {:<12} {:>4}", "", "%");
  for (std::size_t i = 0; i < kMetricColumns.size(); ++i) {
    head += fmt::format(" {:>7}", kHeads[i]);
    units += fmt::format(" {:>7}", kMetricColumns[i].unit);
  }
  std::string text;
  for (const ScenarioRows& scenario : group(comparison)) {
    const std::size_t samples = scenario.modes.front().rows.size() - 1;
    text += fmt::format(
        "{}: {}\n", scenario.scenario,
        samples == 0 ? "the model's own values" : fmt::format("mean of {} sample(s)", samples));
    text += head + " rank\n" + units + "\n";
    const std::vector<RankedMode> ranking = rank(scenario);
    for (const ModeRows& rows : scenario.modes) text += row_text(rows, ranking);
  }
  return text;
}

}  // namespace awmr
