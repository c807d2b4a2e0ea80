// JSON Schema of gains.json. To use the gains, a program needs only the keys `heading` and `speed`.
#include "awmr/core/json.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/gains_json.h"
#include "awmr/model/parameters.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/tune.h"
#include "awmr/tune/tune_json.h"

namespace awmr {
namespace {

/// Scores, by mode, then scenario.
void describe_scores(JsonObject json) {
  for (JsonObject& mode : json.values()) {
    for (JsonObject& score : mode.values()) {
      score.boolean("completed");
      for (const char* key :
           {"objective", "speed_itae_m_s", "sideslip_max_deg", "yaw_rate_max_degps",
            "control_variation", "control_effort", "steering_rate_rms_degps"}) {
        score.number(key);
      }
      for (const char* key : {"settling_time_s", "overshoot_deg", "heading_iae_degs",
                              "heading_itae_degs2", "speed_drop_mps"}) {
        score.nullable_number(key);
      }
      score.reject_unknown_keys();
    }
  }
}

void describe_constraints(JsonObject& json) {
  for (JsonObject& constraint : json.optional_objects("constraints")) {
    constraint.string("name");
    constraint.boolean("required");
    for (const char* key : {"value", "limit", "margin"}) constraint.number(key);
    // Older files have no `sense`. Their text `meaning` says whether the limit is an upper or a
    // lower limit.
    if (constraint.has("sense")) constraint.choice("sense", kSenseNames);
    constraint.string("meaning");
    constraint.reject_unknown_keys();
  }
}

void describe_objective(JsonObject json) {
  json.number("value");
  JsonObject weights = json.object("weights");
  for (const ObjectiveTerm& term : kObjectiveTerms) {
    // Older files have no term "settling".
    if (term.weight != &ObjectiveWeights::settling || weights.has(term.name)) {
      weights.number(term.name, kNonNegative);
    }
  }
  weights.reject_unknown_keys();
  json.string("formula");
  for (JsonObject& term : json.objects("terms")) {
    term.string("name");
    term.string("figure");
    term.number("floor", kPositive);
    term.reject_unknown_keys();
  }
  JsonObject held_out = json.object("held_out");
  held_out.number("value");
  describe_scores(held_out.object("metrics"));
  held_out.reject_unknown_keys();
  json.reject_unknown_keys();
}

void describe_numbers(JsonObject json, std::initializer_list<const char*> keys) {
  for (const char* key : keys) json.number(key);
  json.reject_unknown_keys();
}

void describe_quantiles(JsonObject json) {
  for (JsonObject& mode : json.values()) {
    for (JsonObject& gains : mode.values()) {
      gains.number("completed_share", {.min = 0.0, .max = 1.0});
      for (JsonObject& figure : gains.values()) {
        describe_numbers(figure, {"median", "q95", "tail_mean"});
      }
    }
  }
}

/// SearchHistory: improvements of the objective.
void describe_history(JsonObject json) {
  json.number("evaluations", kNonNegative);
  json.number("global_evaluations", kNonNegative);
  for (JsonObject& step : json.objects("best")) {
    step.number("evaluation", kPositive);
    step.number("objective");
    step.reject_unknown_keys();
  }
  json.reject_unknown_keys();
}

void describe_robust(JsonObject json) {
  json.string("drawn_from");
  for (const char* key : {"draws", "seed", "tail_share", "motor_time_constant_s", "judged_draws"}) {
    json.number(key);
  }
  json.optional_number("activity_max");
  describe_numbers(json.object("noise"), {"heading_deg", "yaw_rate_degps", "speed_mps"});
  describe_numbers(json.object("latency"), {"heading_s", "yaw_rate_s", "speed_s"});
  if (auto correlation = json.optional_object("noise_correlation")) {
    describe_numbers(*correlation, {"heading_s", "yaw_rate_s", "speed_s"});
  }
  describe_quantiles(json.object("quantiles"));
  if (auto by_scenario = json.optional_object("by_scenario")) {
    for (JsonObject& one : by_scenario->values()) describe_quantiles(one);
  }
  if (auto open = json.optional_object("open")) read_open(std::move(*open));
  // Older files have the nominal gains and the history of their search.
  if (auto nominal = json.optional_object("nominal")) {
    gains_from_json(*nominal);
    nominal->reject_unknown_keys();
  }
  if (auto history = json.optional_object("nominal_history")) describe_history(*history);
  json.reject_unknown_keys();
}

void describe_search(JsonObject json) {
  if (json.has("active")) {
    for (JsonObject& one : json.objects("active")) {
      one.string("name");
      one.number("wider_gains", {.min = 0.0});
      one.reject_unknown_keys();
    }
  }
  if (auto as_good = json.optional_object("as_good")) {
    as_good->number("objective_share", {.min = 0.0, .max = 1.0});
    as_good->interval("mu");
    as_good->interval("speed_mu");
    as_good->reject_unknown_keys();
  }
  json.string("algorithm");
  json.string("stop_reason");
  // Rounding of the simulated runs: "fused" (with fused multiply-add) or "scalar" (without).
  json.optional_string("arithmetic");
  for (const char* key : {"evaluations", "simulated", "seed"}) json.number(key, kNonNegative);
  if (auto history = json.optional_object("history")) describe_history(*history);
  json.reject_unknown_keys();
}

void describe_goals(JsonObject& json) {
  for (JsonObject& goal : json.optional_objects("goals")) {
    JsonObject limits = goal.object("at_most");
    for (const std::string& figure : run_figure_names()) limits.optional_number(figure, kPositive);
    limits.reject_unknown_keys();
    goal.number("share", kGoalShare);
    goal.boolean("soft");
    goal.choice("mode", kYawModeNames);
    goal.string("gains");
    for (const char* key : {"held", "runs"}) goal.number(key, kNonNegative);
    goal.interval("ci95");
    goal.choice("verdict", kGoalVerdictNames);
    goal.reject_unknown_keys();
  }
}

void describe_worst_case(JsonObject json, const char* value) {
  json.nullable_number(value);
  json.number("yaw_rate_degps", kNonNegative);
  JsonObject parameters = json.object("parameters");
  for (const ParameterInfo& parameter : parameter_table()) {
    parameters.optional_number(parameter.name, kNonNegative);
  }
  parameters.reject_unknown_keys();
  json.reject_unknown_keys();
}

/// Worst cases over the model's confidence set, by mode.
void describe_certificate(JsonObject json) {
  json.string("set");  // examined set of plants: kCertifiedSet or kUncertifiedSet
  json.number("damping_min", {.min = -1.0, .max = 1.0});
  json.nullable_number("delay_margin_s", kNonNegative);
  json.string("method");
  for (const char* key :
       {"parameters", "degrees_of_freedom", "latency_s", "motor_time_constant_s"}) {
    json.number(key, kNonNegative);
  }
  json.interval("yaw_rate_degps");
  JsonObject modes = json.object("modes");
  for (JsonObject& mode : modes.values()) {
    mode.optional_interval("yaw_rate_degps");  // absent in older files: that of all modes
    describe_worst_case(mode.object("damping"), "min");
    describe_worst_case(mode.object("delay_margin"), "min_s");
    mode.reject_unknown_keys();
  }
  json.reject_unknown_keys();
}

/// TradeOff: Pareto front of the search, and named gains such as "tuned".
void describe_trade_off(JsonObject json) {
  const auto describe_point = [](JsonObject& point) {
    for (const char* key : {"settling_time_s", "control_variation"})
      point.number(key, kNonNegative);
    point.reject_unknown_keys();
  };
  for (JsonObject& point : json.objects("front")) describe_point(point);
  JsonObject gains = json.object("gains");
  for (JsonObject& point : gains.values()) describe_point(point);
  json.reject_unknown_keys();
}

void describe_limits(JsonObject json) {
  TuningLimits kept;
  limit_options(kept, [&](const char* key, const auto& value, const NumberRule& rule) {
    if constexpr (std::is_same_v<decltype(value), const double&>) {
      json.number(key, rule);
    } else {
      json.optional_number(key, rule);
    }
  });
  json.reject_unknown_keys();
}

void describe_baseline(JsonObject json) {
  gains_from_json(json);
  json.optional_string("source");  // source of the baseline; absent: the paper's gains
  json.number("objective");
  describe_scores(json.object("metrics"));
  json.reject_unknown_keys();
}

void describe_tuning(JsonObject& json) {
  gains_from_json(json);
  if (auto times = json.optional_object("time_constants")) {
    describe_numbers(*times, {"T1_s", "T2_s"});
  }
  describe_constraints(json);
  if (auto examined = json.optional_object("examined")) read_examined(std::move(*examined));
  if (auto limits = json.optional_object("limits")) describe_limits(*limits);
  if (auto certificate = json.optional_object("certificate")) describe_certificate(*certificate);
  if (auto trade_off = json.optional_object("trade_off")) describe_trade_off(*trade_off);
  if (auto objective = json.optional_object("objective")) describe_objective(*objective);
  if (auto metrics = json.optional_object("metrics")) describe_scores(*metrics);
  if (auto search = json.optional_object("search")) describe_search(*search);
  if (auto robust = json.optional_object("robust")) describe_robust(*robust);
  describe_goals(json);
  if (auto baseline = json.optional_object("baseline")) describe_baseline(*baseline);
}

void describe_gains(JsonObject& json) {
  json.schema(kGainsSchema);
  read_provenance(json);
  json.ignore("version");
  describe_tuning(json);
  // Without `mode` and `modes`, the gains are for every mode of the vehicle.
  if (json.has("mode")) json.choice("mode", kYawModeNames);
  // Modes with their own gains.
  if (auto modes = json.optional_object("modes")) {
    for (const YawMode mode : kYawModes) {
      auto own = modes->optional_object(name_of(mode));
      if (!own) continue;
      describe_tuning(*own);
      own->reject_unknown_keys();
    }
    modes->reject_unknown_keys();
  }
  json.ignore("sensitivity");  // of older files
  read_findings(json);
  json.reject_unknown_keys();
}

}  // namespace

std::string gains_schema() {
  return json_schema_text(kGainsSchema, "Gains and their origin", describe_gains);
}

}  // namespace awmr
