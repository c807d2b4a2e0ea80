// Writes the text of comparison.json.

#include <fmt/format.h>

#include <algorithm>

#include "awmr/compare/decision.h"
#include "awmr/compare/metric_columns.h"
#include "awmr/compare/overall.h"
#include "awmr/compare/ranking.h"
#include "awmr/compare/scoring.h"
#include "awmr/compare/statistics.h"
#include "awmr/core/files/hash.h"
#include "awmr/core/json/json.h"
#include "awmr/core/statistics/binomial.h"
#include "awmr/simulate/batch.h"

namespace awmr {
namespace {

Json summary_json(const Summary& summary) {
  return {{"nominal", value_or_null(summary.nominal)}, {"count", summary.count},
          {"mean", value_or_null(summary.mean)},       {"q05", value_or_null(summary.q05)},
          {"q50", value_or_null(summary.q50)},         {"q95", value_or_null(summary.q95)}};
}

Json mode_json(const ModeRows& rows) {
  Json json;
  const std::size_t runs = rows.counted().size();
  json["completed"] = {
      {"nominal", rows.nominal().completed},
      {"count", rows.completed_count()},
      {"of", runs},
      {"share", rows.completed_share()},
      {"ci95",
       value_or_null(runs >= 2 ? std::optional(clopper_pearson(rows.completed_count(), runs))
                               : std::nullopt)}};
  json["metrics"] = Json::object();
  for (const MetricColumn& metric : kMetricColumns) {
    json["metrics"][std::string(metric.name)] = summary_json(summarise(rows, metric));
  }
  return json;
}

void put_conclusion(Json& json, const char* key, const std::optional<Conclusion>& conclusion) {
  if (conclusion) json[key] = name_in(kConclusionNames, *conclusion);
}

Json difference_json(const PairedDifference& d) {
  Json json = {{"first", d.first.label()},
               {"second", d.second.label()},
               {"metric", d.metric->name},
               {"nominal", value_or_null(d.nominal)},
               {"count", d.count},
               {"mean", value_or_null(d.mean)},
               {"ci95", value_or_null(d.ci95)},
               {"p", value_or_null(d.p)},
               {"p_holm", value_or_null(d.p_holm)},
               {"margin", d.margin},
               {"p_equivalent", value_or_null(d.p_equivalent)}};
  put_conclusion(json, "conclusion", d.conclusion);
  return json;
}

Json ranked_json(const RankedMode& ranked) {
  Json json = {{"rank", ranked.rank},
               {"mode", ranked.contender.label()},
               {"score", ranked.score},
               {"completed_share", ranked.completed_share},
               {"behind_ci95", value_or_null(ranked.behind_ci95)},
               {"tied_with", ranked.tied_with},
               {"first_by_weights", ranked.first_by_weights},
               {"first_by_samples", value_or_null(ranked.first_by_samples)},
               {"dominated_by", ranked.dominated_by}};
  put_conclusion(json, "towards_leader", ranked.towards_leader);
  return json;
}

Json labels_json(const std::vector<Contender>& contenders) {
  Json labels = Json::array();
  for (const Contender& one : contenders) labels.push_back(one.label());
  return labels;
}

/// Writes the decision on a scenario as JSON. `all`: the changes of all scenarios; changes of this
/// scenario that could not be run are added with the reason.
Json decision_json(const std::string& scenario, const Decision& decision,
                   const std::vector<Change>& all) {
  Json json = {{"kind", name_in(kDecisionKindNames, decision.kind())},
               {"first", labels_json(decision.first)},
               {"never_behind", labels_json(decision.never_behind())},
               {"deciding_trials", decision.deciding_trials()},
               {"changes", Json::array()}};
  if (decision.narrow_lead) {
    json["narrow_lead"] = {{"metric", decision.narrow_lead->metric->name},
                           {"over", labels_json(decision.narrow_lead->others)}};
  }
  for (const Change& change : decision.changes) {
    Json& entry =
        json["changes"].emplace_back(Json{{"kind", name_in(kChangeKindNames, change.kind)},
                                          {"setting", change.setting},
                                          {"first", labels_json(change.first)},
                                          {"survives", decision.survives(change)}});
    for (const Completion& one : change.completed) {
      entry["completed"][one.contender.label()] = {{"count", one.count}, {"of", one.of}};
    }
  }
  for (const Change& change : all) {
    if (change.scenario != scenario || change.not_run.empty()) continue;
    json["changes"].push_back({{"kind", name_in(kChangeKindNames, change.kind)},
                               {"setting", change.setting},
                               {"not_run", change.not_run}});
  }
  return json;
}

Json scenario_json(const EvaluatedScenario& scenario, const std::vector<Change>& changes) {
  Json json;
  json["name"] = scenario.rows.scenario;
  json["modes"] = Json::object();
  for (const ModeRows& rows : scenario.rows.modes) json["modes"][rows.label()] = mode_json(rows);
  json["paired_differences"] = Json::array();
  for (const PairedDifference& d : scenario.differences) {
    // A metric that does not apply to the scenario has no difference.
    if (d.nominal || d.mean) json["paired_differences"].push_back(difference_json(d));
  }
  json["ranking"] = Json::array();
  for (const RankedMode& ranked : scenario.ranking) json["ranking"].push_back(ranked_json(ranked));
  if (json["ranking"].empty()) {
    json["ranking_note"] = kNotRanked;
  }
  if (scenario.decision) {
    json["decision"] = decision_json(scenario.rows.scenario, *scenario.decision, changes);
  }
  json["verdict"] = scenario.verdict;
  return json;
}

/// Scenarios that the summaries leave out, because an earlier scenario has identical runs.
Json counted_once_json(const std::vector<EvaluatedScenario>& ranked) {
  const std::vector<std::size_t> first = first_with_same_runs(ranked);
  Json json = Json::array();
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    if (first[i] == i) continue;
    json.push_back(
        {{"scenario", ranked[i].rows.scenario}, {"same_runs_as", ranked[first[i]].rows.scenario}});
  }
  return json;
}

Json overall_json(const std::vector<EvaluatedScenario>& ranked) {
  Json json = Json::array();
  for (const MetricTally& one : tally(ranked)) {
    Json counts = Json::object();
    for (std::size_t i = 0; i < one.best_or_tied.size(); ++i) {
      counts[ranked.front().rows.modes[i].label()] = one.best_or_tied[i];
    }
    json.push_back(
        {{"metric", one.metric->name}, {"scenarios", one.scenarios}, {"best_or_tied", counts}});
  }
  return json;
}

Json decisions_json(const std::vector<EvaluatedScenario>& ranked) {
  DecisionTally tally = tally_decisions(ranked);
  Json json;
  for (const auto& [name, kind] : kDecisionKindNames) {
    json[std::string(name)] = tally.scenarios[kind];
  }
  for (const auto& [name, kind] : kChangeKindNames) {
    const DecisionTally::Share& share = tally.survived[kind];
    json["survived"][std::string(name)] = {{"count", share.count}, {"of", share.of}};
  }
  return json;
}

Json break_even_json(const std::vector<BreakEven>& entries) {
  Json json = Json::array();
  for (const BreakEven& entry : entries) {
    json.push_back({{"scenario", entry.scenario},
                    {"mode", name_of(entry.mode)},
                    {"against", name_of(entry.against)},
                    {"yaw_coulomb_m", value_or_null(entry.yaw_coulomb_m)},
                    {"most_m", entry.most_m},
                    {"sliding_m", entry.sliding_m},
                    {"fastest_degps", entry.fastest_degps}});
    if (entry.measured_m) {
      json.back()["measured_m"] = {entry.measured_m->lo, entry.measured_m->hi};
      json.back()["lead"] = name_in(kLeadNames, *lead_of(entry));
    }
    if (entry.measured_degps) {
      json.back()["measured_degps"] = {entry.measured_degps->lo, entry.measured_degps->hi};
    }
    if (entry.turns_to_decide) json.back()["turns_to_decide"] = *entry.turns_to_decide;
  }
  return json;
}

Json statistics_json(int samples) {
  Json json;
  json["over"] = samples > 0 ? "samples 1 and up" : "the nominal run alone";
  json["paired_differences"] = "first minus second, by sample";
  json["ci95"] = samples >= 2 ? "of the mean, percentile bootstrap over samples"
                              : "null: an interval needs at least 2 samples (option samples)";
  json["p"] = samples >= 2 ? "two-sided, paired t test of the mean difference"
                           : "null: a test needs at least 2 samples (option samples)";
  json["p_holm"] = samples >= 2 ? "p corrected for all differences of the scenario (Holm)"
                                : "null: a test needs at least 2 samples (option samples)";
  json["margin"] =
      "the larger of the metric's floor and `relevance` times the smaller of the two means";
  json["conclusion"] = samples >= 2
                           ? "relevant: p_holm below 0.05 and ci95 beyond the margin; equivalent: "
                             "p_equivalent (two one-sided t tests, TOST) below 0.05; else undecided"
                           : "relevant if the difference is beyond the margin, else equivalent";
  json["completed_ci95"] = samples >= 2
                               ? "of the share, exact (Clopper-Pearson)"
                               : "null: an interval needs at least 2 samples (option samples)";
  json["resamples"] = samples >= 2 ? Json(kResamples) : Json(nullptr);
  json["quantiles"] = samples >= 2
                          ? "5, 50 and 95 %, linearly interpolated between the sorted values"
                          : "null: quantiles need at least 2 samples (option samples)";
  return json;
}

Json ranking_json(const Preferences& preferences) {
  Json json;
  json["score"] = kScoreFormula;
  json["relevance"] = preferences.relevance;
  json["metrics"] = Json::array();
  for (const MetricColumn& metric : kMetricColumns) {
    if (!metric.can_rank()) continue;
    json["metrics"].push_back({{"name", metric.name},
                               {"floor", metric.ranking_floor},
                               {"weight", weight_of(metric, preferences)}});
  }
  json["first_by_weights"] =
      "fraction of random weightings of the metrics (uniform over all weightings that sum to 1) "
      "with which the mode has the best score. A weighting is divided equally among all modes "
      "within relevance of the best score. Modes that are tied for best have the mean of their "
      "fractions";
  json["decision"] = fmt::format(
      "decided: exactly one mode has rank 1 in the ranking and under every change of one "
      "assumption; level: several modes have rank 1 in all of these; undecided: no mode has rank 1 "
      "in all of these, or the lead of the best mode rests on one metric and is lost if this "
      "metric has half its weight (narrow_lead). A mode that completes no run does not have rank "
      "1. Changes: any weights within a factor {:g}; with option plant both, also the plant that "
      "the scenario does not use; with option plant both and a single set of gains, also gains "
      "that multiply and divide the rates of heading and speed loop by {:.3g}. Changes of plant "
      "and gains have up to {} samples each",
      kWeightFactor, kGainsFactor, kBatchRuns - 1);
  return json;
}

}  // namespace

std::string comparison_text(const Comparison& comparison, const CompareOptions& options,
                            const Provenance& provenance) {
  Json json = output_document("awmr.comparison/1", provenance);
  json["arithmetic"] = comparison.arithmetic;
  // The hash ties comparison.json to the comparison.csv that was written with it.
  json["csv_sha256"] = sha256_hex(comparison_csv(comparison));
  const Comparison evaluated = evaluated_part(comparison);
  const int samples =
      comparison.stopped ? std::max(0, evaluated.whole_samples - 1) : options.samples;
  json["samples"] = options.samples;
  if (comparison.stopped) {
    json["stopped"] = {{"finished_runs", comparison.rows.size()}, {"judged_samples", samples}};
  }
  json["seed"] = options.seed;
  json["statistics"] = statistics_json(samples);
  json["ranking"] = ranking_json(options.preferences);
  const std::vector<EvaluatedScenario> scenarios =
      evaluate_scenarios(evaluated, options.preferences, options.seed);
  const std::vector<EvaluatedScenario> ranked = ranked_of(scenarios);
  json["overall"] = overall_json(ranked);
  json["counted_once"] = counted_once_json(ranked);
  json["decisions"] = decisions_json(ranked);
  if (comparison.break_even) json["break_even"] = break_even_json(*comparison.break_even);
  json["scenarios"] = Json::array();
  for (const EvaluatedScenario& scenario : scenarios)
    json["scenarios"].push_back(scenario_json(scenario, evaluated.changes));
  return to_text(json);
}

}  // namespace awmr
