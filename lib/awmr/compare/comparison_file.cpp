// comparison.csv and comparison.json.

#include "awmr/compare/ranking.h"
#include "awmr/compare/statistics.h"
#include "awmr/core/csv.h"
#include "awmr/core/json.h"

namespace awmr {
namespace {

/// A text cell, quoted where it has to be.
std::string cell(const std::string& text) {
  if (text.find_first_of(",;\t\"#\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json summary_json(const Summary& summary) {
  return {{"nominal", optional_json(summary.nominal)}, {"count", summary.count},
          {"mean", optional_json(summary.mean)},       {"q05", optional_json(summary.q05)},
          {"q50", optional_json(summary.q50)},         {"q95", optional_json(summary.q95)}};
}

Json mode_json(const ModeRows& rows) {
  Json json;
  json["completed"] = {{"nominal", rows.nominal().completed}, {"share", rows.completed_share()}};
  json["metrics"] = Json::object();
  for (const MetricColumn& metric : kMetricColumns) {
    json["metrics"][std::string(metric.name)] = summary_json(summarise(rows, metric));
  }
  return json;
}

Json difference_json(const PairedDifference& d) {
  return {{"first", name_of(d.first)},
          {"second", name_of(d.second)},
          {"metric", d.metric},
          {"nominal", optional_json(d.nominal)},
          {"count", d.count},
          {"mean", optional_json(d.mean)},
          {"ci95", d.ci95 ? Json::array({d.ci95->lo, d.ci95->hi}) : Json(nullptr)}};
}

Json ranked_json(const RankedMode& ranked) {
  Json json = {{"rank", ranked.rank},
               {"mode", name_of(ranked.mode)},
               {"score", ranked.score},
               {"completed_share", ranked.completed_share},
               {"tied_with", Json::array()}};
  for (const YawMode mode : ranked.tied_with) json["tied_with"].push_back(name_of(mode));
  return json;
}

Json scenario_json(const ScenarioRows& scenario, std::uint64_t seed, std::uint64_t stream) {
  Json json;
  json["name"] = scenario.scenario;
  json["modes"] = Json::object();
  for (const ModeRows& rows : scenario.modes) {
    json["modes"][std::string(name_of(rows.mode))] = mode_json(rows);
  }
  json["paired_differences"] = Json::array();
  for (const PairedDifference& d : paired_differences(scenario, seed, stream)) {
    // A metric without meaning for the scenario has no difference either.
    if (d.nominal || d.mean) json["paired_differences"].push_back(difference_json(d));
  }
  json["ranking"] = Json::array();
  for (const RankedMode& ranked : rank(scenario)) json["ranking"].push_back(ranked_json(ranked));
  if (json["ranking"].empty()) {
    json["ranking_note"] = "not ranked: the scenario gives the vehicle nothing to follow";
  }
  return json;
}

Json statistics_json(int samples) {
  Json json;
  json["over"] = samples > 0 ? "samples 1 and up" : "the nominal run alone";
  json["paired_differences"] = "first minus second, by sample";
  json["ci95"] = samples >= 2 ? "of the mean, percentile bootstrap over samples"
                              : "null: an interval needs at least 2 samples (--samples)";
  json["resamples"] = samples >= 2 ? Json(kResamples) : Json(nullptr);
  json["quantiles"] = samples >= 2 ? "5, 50 and 95 %, linear between order statistics"
                                   : "null: quantiles need at least 2 samples (--samples)";
  return json;
}

Json ranking_json() {
  Json json;
  json["score"] = kScoreFormula;
  json["metrics"] = Json::array();
  for (const MetricColumn& metric : kMetricColumns) {
    if (!(metric.ranking_floor > 0.0)) continue;
    json["metrics"].push_back({{"name", metric.name}, {"floor", metric.ranking_floor}});
  }
  json["tie_margin"] = kTieMargin;
  return json;
}

}  // namespace

std::string comparison_csv(const Comparison& comparison) {
  std::string text = "scenario,mode,sample,completed";
  for (const MetricColumn& metric : kMetricColumns) {
    text += ',';
    text += metric.name;
  }
  text += '\n';
  for (const ComparisonRow& row : comparison.rows) {
    text += cell(row.scenario);
    text += ',';
    text += name_of(row.mode);
    text += ',' + std::to_string(row.sample) + (row.metrics.completed ? ",1" : ",0");
    for (const MetricColumn& metric : kMetricColumns) {
      text += ',';
      if (const auto value = metric.value(row.metrics)) text += format_number(*value);
    }
    text += '\n';
  }
  return text;
}

std::string comparison_text(const Comparison& comparison, const CompareOptions& options,
                            const Provenance& provenance) {
  Json json;
  json["schema"] = "awmr.comparison/1";
  put_provenance(json, provenance);
  json["samples"] = options.samples;
  json["seed"] = options.seed;
  json["statistics"] = statistics_json(options.samples);
  json["ranking"] = ranking_json();
  json["scenarios"] = Json::array();
  std::uint64_t stream = 0;
  for (const ScenarioRows& scenario : group(comparison)) {
    json["scenarios"].push_back(scenario_json(scenario, options.seed, stream++));
  }
  return to_text(json);
}

}  // namespace awmr
