// JSON Schema of comparison.json.
#include <limits>

#include "awmr/compare/decision.h"
#include "awmr/compare/metric_columns.h"
#include "awmr/core/json.h"
#include "awmr/model/findings_json.h"

namespace awmr {
namespace {

constexpr long kMax = std::numeric_limits<int>::max();
constexpr NumberRule kShareOfRuns{.min = 0.0, .max = 1.0};

void describe_completed(JsonObject json) {
  json.boolean("nominal");
  json.integer("count", 0, kMax);
  json.integer("of", 0, kMax);
  json.number("share", kShareOfRuns);
  json.nullable_interval("ci95");
  json.reject_unknown_keys();
}

void describe_metrics(JsonObject json) {
  for (const MetricColumn& metric : kMetricColumns) {
    JsonObject summary = json.object(metric.name);
    summary.integer("count", 0, kMax);
    for (const char* key : {"nominal", "mean", "q05", "q50", "q95"}) summary.nullable_number(key);
    summary.reject_unknown_keys();
  }
  json.reject_unknown_keys();
}

void describe_differences(JsonObject& scenario) {
  for (JsonObject& one : scenario.objects("paired_differences")) {
    for (const char* key : {"first", "second", "metric"}) one.string(key);
    one.integer("count", 0, kMax);
    for (const char* key : {"nominal", "mean", "p", "p_holm", "p_equivalent"}) {
      one.nullable_number(key);
    }
    one.nullable_interval("ci95");
    one.number("margin", kNonNegative);
    one.optional_string("conclusion");
    one.reject_unknown_keys();
  }
}

void describe_ranking(JsonObject& scenario) {
  for (JsonObject& ranked : scenario.objects("ranking")) {
    ranked.integer("rank", 1, kMax);
    ranked.string("mode");
    ranked.number("score", kPositive);
    ranked.number("completed_share", kShareOfRuns);
    ranked.nullable_interval("behind_ci95");
    ranked.optional_string("towards_leader");
    ranked.strings("tied_with");
    ranked.number("first_by_weights", kShareOfRuns);
    ranked.nullable_number("first_by_samples", kShareOfRuns);
    ranked.strings("dominated_by");
    ranked.reject_unknown_keys();
  }
  scenario.optional_string("ranking_note");
}

void describe_decision(JsonObject& scenario) {
  auto decision = scenario.optional_object("decision");
  if (!decision) return;
  decision->choice("kind", kDecisionKindNames);
  for (const char* key : {"first", "never_behind", "deciding_trials"}) decision->strings(key);
  if (auto lead = decision->optional_object("narrow_lead")) {
    lead->string("metric");
    lead->strings("over");
    lead->reject_unknown_keys();
  }
  for (JsonObject& change : decision->objects("changes")) {
    change.choice("kind", kChangeKindNames);
    change.string("setting");
    // A change of one assumption has the key `first` with the modes of rank 1. If the runs with
    // this change were not made, it has the key `not_run` with the reason, in place of `first`.
    if (change.has("first")) change.strings("first");
    change.optional_boolean("survives");
    change.optional_string("not_run");
    if (auto completed = change.optional_object("completed")) {
      for (JsonObject& mode : completed->values()) {
        mode.integer("count", 0, kMax);
        mode.integer("of", 1, kMax);
        mode.reject_unknown_keys();
      }
    }
    change.reject_unknown_keys();
  }
  decision->reject_unknown_keys();
}

void describe_scenarios(JsonObject& json) {
  for (JsonObject& scenario : json.objects("scenarios")) {
    scenario.string("name");
    for (JsonObject& mode : scenario.object("modes").values()) {
      describe_completed(mode.object("completed"));
      describe_metrics(mode.object("metrics"));
      mode.reject_unknown_keys();
    }
    describe_differences(scenario);
    describe_ranking(scenario);
    describe_decision(scenario);
    scenario.string("verdict");
    scenario.reject_unknown_keys();
  }
}

void describe_overall(JsonObject& json) {
  for (JsonObject& tally : json.objects("overall")) {
    tally.string("metric");
    tally.integer("scenarios", 0, kMax);
    JsonObject counts = tally.object("best_or_tied");
    for (const std::string& mode : counts.keys()) counts.integer(mode, 0, kMax);
    tally.reject_unknown_keys();
  }
  for (JsonObject& same : json.objects("counted_once")) {
    same.string("scenario");
    same.string("same_runs_as");
    same.reject_unknown_keys();
  }
}

void describe_decisions(JsonObject& json) {
  auto decisions = json.optional_object("decisions");
  if (!decisions) return;
  for (const auto& kind : kDecisionKindNames) decisions->integer(kind.name, 0, kMax);
  JsonObject survived = decisions->object("survived");
  for (const auto& kind : kChangeKindNames) {
    JsonObject share = survived.object(kind.name);
    share.integer("count", 0, kMax);
    share.integer("of", 0, kMax);
    share.reject_unknown_keys();
  }
  survived.reject_unknown_keys();
  decisions->reject_unknown_keys();
}

void describe_break_even(JsonObject& json) {
  for (JsonObject& entry : json.optional_objects("break_even")) {
    entry.string("scenario");
    entry.choice("mode", kYawModeNames);
    entry.choice("against", kYawModeNames);
    entry.nullable_number("yaw_coulomb_m", kPositive);
    entry.number("most_m", kPositive);
    entry.number("sliding_m", kPositive);
    entry.number("fastest_degps", kNonNegative);
    entry.optional_interval("measured_m");
    entry.optional_interval("measured_degps");
    // `lead` is present if `measured_m` is present.
    if (entry.has("lead")) entry.choice("lead", kLeadNames);
    entry.optional_integer("turns_to_decide", 0, kMax);
    entry.reject_unknown_keys();
  }
}

void describe_how(JsonObject& json) {
  JsonObject statistics = json.object("statistics");
  for (const char* key : {"over", "paired_differences", "ci95", "p", "p_holm", "margin",
                          "conclusion", "completed_ci95", "quantiles"}) {
    statistics.string(key);
  }
  statistics.nullable_number("resamples", kPositive);
  statistics.reject_unknown_keys();
  JsonObject ranking = json.object("ranking");
  ranking.string("score");
  for (JsonObject& metric : ranking.objects("metrics")) {
    metric.string("name");
    metric.number("floor", kPositive);
    metric.number("weight", {.min = 0.0, .max = kMaximumWeight});
    metric.reject_unknown_keys();
  }
  ranking.number("relevance", kShareOfRuns);
  ranking.string("first_by_weights");
  ranking.optional_string("decision");
  ranking.reject_unknown_keys();
}

void describe_comparison(JsonObject& json) {
  json.schema("awmr.comparison/1");
  read_provenance(json);
  json.optional_string("arithmetic");  // rounding of the runs: "fused" or "scalar"
  json.string("csv_sha256");
  json.integer("samples", 0, kMax);
  if (auto stopped = json.optional_object("stopped")) {
    stopped->integer("finished_runs", 0, kMax);
    stopped->integer("judged_samples", 0, kMax);
    stopped->reject_unknown_keys();
  }
  json.number("seed", kNonNegative);
  describe_how(json);
  describe_overall(json);
  describe_decisions(json);
  describe_break_even(json);
  describe_scenarios(json);
  read_findings(json);
  json.reject_unknown_keys();
}

}  // namespace

std::string comparison_schema() {
  return json_schema_text("awmr.comparison/1", "The yaw-control modes over scenarios",
                          describe_comparison);
}

}  // namespace awmr
