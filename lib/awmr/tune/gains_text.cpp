// Writes gains.json.

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/json/json.h"
#include "awmr/core/units.h"
#include "awmr/model/gains_json.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/tune.h"
#include "awmr/tune/tune_json.h"

namespace awmr {
namespace {

Json score_json(const ModeScore& score) {
  const Metrics& m = score.metrics;
  return {{"objective", score.objective},
          {"completed", m.completed},
          {"settling_time_s", value_or_null(m.settling_time_s)},
          {"overshoot_deg", value_or_null(m.overshoot_deg)},
          {"heading_iae_degs", value_or_null(m.heading_iae_degs)},
          {"heading_itae_degs2", value_or_null(m.heading_itae_degs2)},
          {"speed_itae_m_s", m.speed_itae_m_s},
          {"speed_drop_mps", value_or_null(m.speed_drop_mps)},
          {"sideslip_max_deg", m.sideslip_max_deg},
          {"yaw_rate_max_degps", m.yaw_rate_max_degps},
          {"control_variation", m.control_variation},
          {"control_effort", m.control_effort},
          {"steering_rate_rms_degps", m.steering_rate_rms_degps}};
}

Json active_json(const std::vector<ActiveConstraint>& active) {
  Json json = Json::array();
  for (const ActiveConstraint& one : active) {
    json.push_back({{"name", one.name}, {"wider_gains", one.wider_gains}});
  }
  return json;
}

/// The scores, by mode, then scenario.
Json scores_json(const std::vector<ModeScore>& scores) {
  Json json = Json::object();
  for (const ModeScore& score : scores) {
    json[std::string(name_of(score.mode))][score.scenario] = score_json(score);
  }
  return json;
}

Json constraints_json(const std::vector<ConstraintReport>& constraints) {
  Json json = Json::array();
  for (const ConstraintReport& c : constraints) {
    json.push_back({{"name", c.name},
                    {"required", c.required},
                    {"value", c.value},
                    {"limit", c.limit},
                    {"sense", name_in(kSenseNames, c.sense)},
                    {"margin", c.margin},
                    {"meaning", c.meaning}});
  }
  return json;
}

Json history_json(const SearchHistory& history) {
  Json best = Json::array();
  for (const SearchStep& step : history.best) {
    best.push_back({{"evaluation", step.evaluation}, {"objective", step.objective}});
  }
  return {{"evaluations", history.evaluations},
          {"global_evaluations", history.global_evaluations},
          {"best", std::move(best)}};
}

std::string_view drawn_from(const RobustTuning& robust, const TuneOptions& options) {
  if (options.open.any()) {
    return robust.from_covariance ? "covariance and unmodelled variation" : "unmodelled variation";
  }
  return robust.from_covariance ? "covariance" : "noise alone";
}

Json robust_json(const RobustTuning& robust, const TuneOptions& options) {
  const LoopConditions& c = robust.conditions;
  Json json = {{"draws", options.draws},
               {"drawn_from", drawn_from(robust, options)},
               {"seed", options.seed},
               {"tail_share", options.tail_share},
               {"noise",
                {{"heading_deg", c.heading_noise_deg},
                 {"yaw_rate_degps", c.yaw_rate_noise_degps},
                 {"speed_mps", c.speed_noise_mps}}},
               {"latency",
                {{"heading_s", c.heading_latency_s},
                 {"yaw_rate_s", c.yaw_rate_latency_s},
                 {"speed_s", c.speed_latency_s}}},
               {"motor_time_constant_s", c.motor_time_constant_s},
               {"judged_draws", options.evaluation_draws},
               {"quantiles", quantiles_json(robust.evaluated)}};
  if (c.heading_correlation_s > 0.0 || c.yaw_rate_correlation_s > 0.0 ||
      c.speed_correlation_s > 0.0) {
    json["noise_correlation"] = {{"heading_s", c.heading_correlation_s},
                                 {"yaw_rate_s", c.yaw_rate_correlation_s},
                                 {"speed_s", c.speed_correlation_s}};
  }
  if (options.open.any()) json["open"] = open_json(options.open);
  if (options.activity_max) json["activity_max"] = *options.activity_max;
  if (!robust.evaluated_by_scenario.empty()) {
    json["by_scenario"] = by_scenario_json(robust.evaluated_by_scenario);
  }
  return json;
}

Json limits_json(const TuningLimits& limits) {
  Json json = Json::object();
  limit_options(limits, [&](const char* key, const std::optional<double>& limit, const auto&) {
    if (limit) json[key] = *limit;
  });
  return json;
}

Json objective_json(const Tuning& tuning, const TuneOptions& options) {
  const ObjectiveWeights& weights = options.weights;
  Json json;
  json["value"] = tuning.objective;
  json["weights"] = Json::object();
  json["formula"] =
      "exp of the mean over modes and scenarios of sum_i w_i ln((x_i + f_i)/(x0_i + f_i)) / sum_i "
      "w_i; x: metrics with the tuned gains; x0: with the baseline gains in the same mode and "
      "scenario; w: weights; f: floors, below which differences do not matter";
  if (std::ranges::any_of(options.goals, &TuningGoal::is_soft)) {
    json["formula"] =
        json["formula"].get<std::string>() +
        "; plus max(0, q - 1) for each soft goal and mode; q: the largest ratio of a metric to its "
        "limit in the goal, as a quantile over the drawn vehicles";
  }
  json["terms"] = Json::array();
  for (const ObjectiveTerm& term : kObjectiveTerms) {
    json["weights"][term.name] = weights.*term.weight;
    json["terms"].push_back({{"name", term.name}, {"figure", term.figure}, {"floor", term.floor}});
  }
  json["held_out"] = {{"value", tuning.held_out_objective},
                      {"metrics", scores_json(tuning.held_out_scores)}};
  return json;
}

Json examined_json(const ExaminedRange& range) {
  return {{"speed_mps", range.speed_mps},
          {"step_deg", degrees(range.step_rad)},
          {"yaw_rate_degps", degrees(range.yaw_rate_radps)}};
}

Json search_json(const Tuning& tuning) {
  return {{"algorithm", tuning.algorithm},
          {"evaluations", tuning.evaluations},
          {"simulated", tuning.simulated},
          {"seed", tuning.seed},
          {"arithmetic", tuning.arithmetic},
          {"active", active_json(tuning.active)},
          {"as_good",
           {{"objective_share", kIndifferent},
            {"mu", value_or_null(tuning.mu_as_good)},
            {"speed_mu", value_or_null(tuning.speed_mu_as_good)}}},
          {"stop_reason", tuning.stop_reason},
          {"history", history_json(tuning.history)}};
}

Json baseline_json(const Tuning& tuning) {
  Json json = gains_to_json(tuning.baseline.gains.common());
  json["source"] = tuning.baseline.source;
  json["objective"] = tuning.baseline_objective;
  json["metrics"] = scores_json(tuning.baseline_scores);
  return json;
}

void put_results(const Tuning& tuning, const TuneOptions& options, Json& json) {
  json["time_constants"] = {{"T1_s", tuning.gains.heading.sliding_time_constant_s()},
                            {"T2_s", tuning.gains.heading.reaching_time_constant_s()}};
  json["constraints"] = constraints_json(tuning.constraints);
  json["limits"] = limits_json(tuning.limits);
  json["examined"] = examined_json(tuning.examined);
  if (tuning.certificate) json["certificate"] = certificate_json(*tuning.certificate);
  if (!tuning.trade_off.named.empty()) json["trade_off"] = trade_off_json(tuning.trade_off);
  json["objective"] = objective_json(tuning, options);
  json["metrics"] = scores_json(tuning.scores);
  json["search"] = search_json(tuning);
  if (tuning.robust) json["robust"] = robust_json(*tuning.robust, options);
  if (!options.goals.empty()) json["goals"] = goals_json(tuning.robust->goals);
  json["baseline"] = baseline_json(tuning);
}

}  // namespace

std::string gains_text(const Tuning& tuning, const TuneOptions& options,
                       const Provenance& provenance) {
  Json json;
  json["schema"] = kGainsSchema;
  json.update(gains_to_json(tuning.gains));
  if (options.mode) json["mode"] = name_of(*options.mode);
  put_results(tuning, options, json);
  for (const Tuning& one : tuning.own) {
    Json& own = json["modes"][std::string(name_of(*one.mode))];
    own = gains_to_json(one.gains);
    put_results(one, options, own);
  }
  if (json.contains("certificate")) json["certificate"]["gains_sha256"] = sha256_of_gains(json);
  put_provenance(json, provenance);
  return to_text(json);
}

}  // namespace awmr
