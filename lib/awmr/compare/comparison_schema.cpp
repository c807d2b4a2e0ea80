// JSON Schema of comparison.json.
#include <limits>

#include "awmr/compare/decision.h"
#include "awmr/compare/metric_columns.h"
#include "awmr/core/json/json.h"
#include "awmr/model/findings_json.h"

namespace awmr {
namespace {

constexpr long kMax = std::numeric_limits<int>::max();
constexpr NumberRule kShareOfRuns{.min = 0.0, .max = 1.0};

void describe_completed(JsonObject& json) {
  json.boolean("nominal");
  json.integer("count", 0, kMax);
  json.integer("of", 0, kMax);
  json.number("share", kShareOfRuns);
  json.nullable_interval("ci95");
}

void describe_metrics(JsonObject& json) {
  for (const MetricColumn& metric : kMetricColumns) {
    json.object(metric.name, [](JsonObject& summary) {
      summary.integer("count", 0, kMax);
      for (const char* key : {"nominal", "mean", "q05", "q50", "q95"}) summary.nullable_number(key);
    });
  }
}

void describe_difference(JsonObject& one) {
  for (const char* key : {"first", "second", "metric"}) one.string(key);
  one.integer("count", 0, kMax);
  for (const char* key : {"nominal", "mean", "p", "p_holm", "p_equivalent"}) {
    one.nullable_number(key);
  }
  one.nullable_interval("ci95");
  one.number("margin", kNonNegative);
  one.optional_string("conclusion");
}

void describe_ranked(JsonObject& ranked) {
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
}

/// Describes `{count, of}`, where `of` is at least `min_of`.
auto share_of(long min_of) {
  return [min_of](JsonObject& share) {
    share.integer("count", 0, kMax);
    share.integer("of", min_of, kMax);
  };
}

void describe_change(JsonObject& change) {
  change.choice("kind", kChangeKindNames);
  change.string("setting");
  // A change of one assumption has the key `first` with the modes of rank 1. If the runs with
  // this change were not made, it has the key `not_run` with the reason, in place of `first`.
  if (change.has("first")) change.strings("first");
  change.optional_boolean("survives");
  change.optional_string("not_run");
  if (auto completed = change.optional_object("completed")) completed->values(share_of(1));
}

void describe_decision(JsonObject& decision) {
  decision.choice("kind", kDecisionKindNames);
  for (const char* key : {"first", "never_behind", "deciding_trials"}) decision.strings(key);
  decision.optional_object("narrow_lead", [](JsonObject& lead) {
    lead.string("metric");
    lead.strings("over");
  });
  decision.objects("changes", describe_change);
}

void describe_scenario(JsonObject& scenario) {
  scenario.string("name");
  scenario.object("modes").values([](JsonObject& mode) {
    mode.object("completed", describe_completed);
    mode.object("metrics", describe_metrics);
  });
  scenario.objects("paired_differences", describe_difference);
  scenario.objects("ranking", describe_ranked);
  scenario.optional_string("ranking_note");
  scenario.optional_object("decision", describe_decision);
  scenario.string("verdict");
}

void describe_overall(JsonObject& json) {
  json.objects("overall", [](JsonObject& tally) {
    tally.string("metric");
    tally.integer("scenarios", 0, kMax);
    JsonObject counts = tally.object("best_or_tied");
    for (const std::string& mode : counts.keys()) counts.integer(mode, 0, kMax);
  });
  json.objects("counted_once", [](JsonObject& same) {
    same.string("scenario");
    same.string("same_runs_as");
  });
}

void describe_decisions(JsonObject& decisions) {
  for (const auto& kind : kDecisionKindNames) decisions.integer(kind.name, 0, kMax);
  decisions.object("survived", [](JsonObject& survived) {
    for (const auto& kind : kChangeKindNames) survived.object(kind.name, share_of(0));
  });
}

void describe_break_even(JsonObject& entry) {
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
}

void describe_statistics(JsonObject& statistics) {
  for (const char* key : {"over", "paired_differences", "ci95", "p", "p_holm", "margin",
                          "conclusion", "completed_ci95", "quantiles"}) {
    statistics.string(key);
  }
  statistics.nullable_number("resamples", kPositive);
}

void describe_ranking(JsonObject& ranking) {
  ranking.string("score");
  ranking.objects("metrics", [](JsonObject& metric) {
    metric.string("name");
    metric.number("floor", kPositive);
    metric.number("weight", {.min = 0.0, .max = kMaximumWeight});
  });
  ranking.number("relevance", kShareOfRuns);
  ranking.string("first_by_weights");
  ranking.optional_string("decision");
}

void describe_comparison(JsonObject& json) {
  json.schema("awmr.comparison/1");
  read_provenance(json);
  json.optional_string("arithmetic");  // rounding of the runs: "fused" or "scalar"
  json.string("csv_sha256");
  json.integer("samples", 0, kMax);
  json.optional_object("stopped", [](JsonObject& stopped) {
    stopped.integer("finished_runs", 0, kMax);
    stopped.integer("judged_samples", 0, kMax);
  });
  json.number("seed", kNonNegative);
  json.object("statistics", describe_statistics);
  json.object("ranking", describe_ranking);
  describe_overall(json);
  json.optional_object("decisions", describe_decisions);
  json.optional_objects("break_even", describe_break_even);
  json.objects("scenarios", describe_scenario);
  read_findings(json);
  json.reject_unknown_keys();
}

}  // namespace

std::string comparison_schema() {
  return json_schema_text("awmr.comparison/1", "The yaw-control modes over scenarios",
                          describe_comparison);
}

}  // namespace awmr
