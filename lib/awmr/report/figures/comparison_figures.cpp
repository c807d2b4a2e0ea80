#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "awmr/report/figures/figures_of.h"
#include "awmr/report/metric_words.h"

namespace awmr {
namespace {

std::optional<double> number_in(const Json& json, const char* key) {
  if (!json.contains(key) || !json.at(key).is_number()) return std::nullopt;
  return json.at(key).get<double>();
}

/// Returns the name of a scenario in file names, so that figures of runs and of comparisons have
/// the same name. It is SCENARIO if a file scenario_SCENARIO.json has this `name` in its key
/// `name`. If there is no such file, it is `name` itself.
std::string stem_of(const Json& data, const std::string& name) {
  for (const auto& [stem, scenario] : data.at("scenarios").items()) {
    if (scenario.value("name", "") == name) return stem;
  }
  return name;
}

/// One row of the figure of differences: the difference of a metric between two modes with its 95 %
/// interval, in percent of the larger of the two means. If both means are 0, the metric has no row.
struct DifferenceRow {
  std::string metric;
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
  bool relevant = false;
};

std::optional<DifferenceRow> difference_row(const Json& scenario, const Json& one) {
  const auto mean_of = [&](const char* which) {
    const std::string metric = one.at("metric");
    const Json& metrics = scenario.at("modes").at(one.at(which).get<std::string>()).at("metrics");
    if (!metrics.contains(metric)) return 0.0;
    return std::abs(number_in(metrics.at(metric), "mean").value_or(0.0));
  };
  const double scale = std::max(mean_of("first"), mean_of("second"));
  const std::optional<double> mean = number_in(one, "mean");
  if (!(scale > 0.0) || !mean) return std::nullopt;
  DifferenceRow row{metric_words(one.at("metric").get<std::string>()).words, 100.0 * *mean / scale,
                    100.0 * *mean / scale, 100.0 * *mean / scale,
                    one.value("conclusion", "") == "relevant"};
  if (const Json& interval = one.at("ci95"); interval.is_array()) {
    row.low = 100.0 * interval.at(0).get<double>() / scale;
    row.high = 100.0 * interval.at(1).get<double>() / scale;
  }
  return row;
}

/// Paired differences of two modes, one row per metric.
Figure difference_figure(const std::string& stem, const std::string& first,
                         const std::string& second, const std::vector<DifferenceRow>& rows) {
  Series relevant{.name = "relevant", .shape = SeriesShape::kRanges, .role = Role::kModel};
  Series minor{
      .name = "within the margin, or chance", .shape = SeriesShape::kRanges, .role = Role::kMinor};
  Axis metrics;
  for (const DifferenceRow& row : rows) {
    Series& one = row.relevant ? relevant : minor;
    one.x.push_back(row.mean);
    one.y.push_back(static_cast<double>(metrics.rows.size()));
    one.low.push_back(row.low);
    one.high.push_back(row.high);
    metrics.rows.push_back(row.metric);
  }
  Figure figure{.name = figure_name("differences_" + stem, first + "_" + second),
                .meaning = fmt::format("Paired differences of {} minus {} with 95 % intervals, {}",
                                       first, second, stem),
                .x = {.quantity = fmt::format("{} minus {}", first, second),
                      .unit = "% of the larger mean",
                      .zero = true},
                .panels = {{.y = std::move(metrics), .series = {}}}};
  for (Series& one : {std::ref(relevant), std::ref(minor)}) {
    if (!one.x.empty()) figure.panels[0].series.push_back(std::move(one));
  }
  return figure;
}

void add_differences(const Json& scenario, const std::string& stem, FiguresOfResults& all) {
  std::vector<std::pair<std::string, std::string>> pairs;
  std::map<std::pair<std::string, std::string>, std::vector<DifferenceRow>> rows;
  for (const Json& one : scenario.at("paired_differences")) {
    const std::pair<std::string, std::string> pair{one.at("first"), one.at("second")};
    const auto row = difference_row(scenario, one);
    if (!row) continue;
    if (rows.count(pair) == 0) pairs.push_back(pair);
    rows[pair].push_back(*row);
  }
  for (const auto& pair : pairs) {
    all.figures.push_back(difference_figure(stem, pair.first, pair.second, rows[pair]));
  }
}

/// Figure of the distribution of a metric. Each mode has a row, with the value in each sample
/// (simulated vehicle), the median and the range from the 5 to the 95 % quantile. If there are no
/// samples, a row has the value of the nominal run.
Figure spread_figure(const std::string& stem, const std::string& metric, const Json& scenario,
                     const Json& samples) {
  const MetricWords words = metric_words(metric);
  Figure figure{
      .name = figure_name("distribution_" + stem, metric),
      .meaning = fmt::format("{} by mode: samples, median, 5 to 95 %; {}", words.words, stem),
      .x = {.quantity = words.words, .unit = words.unit},
      .panels = {{.y = {}, .series = {}}}};
  Panel& panel = figure.panels[0];
  for (const auto& [mode, of_mode] : scenario.at("modes").items()) {
    if (!of_mode.at("metrics").contains(metric)) continue;
    const Json& summary = of_mode.at("metrics").at(metric);
    auto middle = number_in(summary, "q50");
    const bool has_range = middle.has_value();
    if (!middle) middle = number_in(summary, "nominal");
    if (!middle) continue;
    const auto row = static_cast<double>(panel.y.rows.size());
    panel.y.rows.push_back(mode);
    if (samples.contains(mode) && samples.at(mode).contains(metric)) {
      const auto values = samples.at(mode).at(metric).get<std::vector<double>>();
      panel.series.push_back({.name = "sample",
                              .shape = SeriesShape::kTicks,
                              .role = Role::kMinor,
                              .x = values,
                              .y = std::vector<double>(values.size(), row)});
    }
    panel.series.push_back({.name = has_range ? "median, 5 to 95 %" : "nominal",
                            .shape = SeriesShape::kRanges,
                            .role = Role::kMeasured,
                            .x = {*middle},
                            .y = {row},
                            .low = {number_in(summary, "q05").value_or(*middle)},
                            .high = {number_in(summary, "q95").value_or(*middle)}});
  }
  return figure;
}

/// True if some mode has a value of the metric other than 0, as median or in the nominal run.
bool is_reported(const Json& scenario, const std::string& metric) {
  const Json& modes = scenario.at("modes");
  return std::any_of(modes.begin(), modes.end(), [&](const Json& mode) {
    if (!mode.at("metrics").contains(metric)) return false;
    const Json& summary = mode.at("metrics").at(metric);
    return number_in(summary, "nominal").value_or(0.0) != 0.0 ||
           number_in(summary, "q50").value_or(0.0) != 0.0;
  });
}

void add_spreads(const Json& data, const Json& scenario, const std::string& stem,
                 FiguresOfResults& all) {
  const std::string name = scenario.at("name");
  const bool has_samples = data.contains("samples") && data.at("samples").contains(name);
  const Json samples = has_samples ? data.at("samples").at(name) : Json::object();
  for (const Json& metric : data.at("comparison").at("ranking").at("metrics")) {
    const std::string metric_name = metric.at("name");
    if (!(number_in(metric, "weight").value_or(0.0) > 0.0) || !is_reported(scenario, metric_name)) {
      continue;
    }
    all.figures.push_back(spread_figure(stem, metric_name, scenario, samples));
  }
}

}  // namespace

void add_comparison_figures(const Json& data, FiguresOfResults& all) {
  if (!data.contains("comparison")) {
    all.lacking.push_back(
        "differences and distributions of the modes: there is no comparison.json (awmr compare)");
    return;
  }
  // Distributions are drawn for metrics with a weight in the ranking, differences for all metrics.
  for (const Json& scenario : data.at("comparison").at("scenarios")) {
    const std::string stem = stem_of(data, scenario.at("name"));
    add_spreads(data, scenario, stem, all);
    add_differences(scenario, stem, all);
  }
}

}  // namespace awmr
