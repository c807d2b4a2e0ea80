// JSON Schema of gains.json. To use the gains, a program needs only the keys `heading` and `speed`.
#include "awmr/core/json/json.h"
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

void describe_score(JsonObject& score) {
  score.boolean("completed");
  for (const char* key : {"objective", "speed_itae_m_s", "sideslip_max_deg", "yaw_rate_max_degps",
                          "control_variation", "control_effort", "steering_rate_rms_degps"}) {
    score.number(key);
  }
  for (const char* key : {"settling_time_s", "overshoot_deg", "heading_iae_degs",
                          "heading_itae_degs2", "speed_drop_mps"}) {
    score.nullable_number(key);
  }
}

/// Scores, by mode, then scenario.
void describe_scores(JsonObject json) {
  for (JsonObject& mode : json.values()) mode.values(describe_score);
}

void describe_constraint(JsonObject& constraint) {
  constraint.string("name");
  constraint.boolean("required");
  for (const char* key : {"value", "limit", "margin"}) constraint.number(key);
  // Older files have no `sense`. Their text `meaning` says whether the limit is an upper or a
  // lower limit.
  if (constraint.has("sense")) constraint.choice("sense", kSenseNames);
  constraint.string("meaning");
}

void describe_weights(JsonObject& weights) {
  for (const ObjectiveTerm& term : kObjectiveTerms) {
    // Older files have no term "settling".
    if (term.weight != &ObjectiveWeights::settling || weights.has(term.name)) {
      weights.number(term.name, kNonNegative);
    }
  }
}

void describe_objective(JsonObject& json) {
  json.number("value");
  json.object("weights", describe_weights);
  json.string("formula");
  json.objects("terms", [](JsonObject& term) {
    term.string("name");
    term.string("figure");
    term.number("floor", kPositive);
  });
  json.object("held_out", [](JsonObject& held_out) {
    held_out.number("value");
    describe_scores(held_out.object("metrics"));
  });
}

void describe_quantiles(JsonObject json) {
  for (JsonObject& mode : json.values()) {
    for (JsonObject& gains : mode.values()) {
      gains.number("completed_share", {.min = 0.0, .max = 1.0});
      gains.values(numbers_at({"median", "q95", "tail_mean"}));
    }
  }
}

/// SearchHistory: improvements of the objective.
void describe_history(JsonObject& json) {
  json.number("evaluations", kNonNegative);
  json.number("global_evaluations", kNonNegative);
  json.objects("best", [](JsonObject& step) {
    step.number("evaluation", kPositive);
    step.number("objective");
  });
}

void describe_robust(JsonObject& json) {
  json.string("drawn_from");
  for (const char* key : {"draws", "seed", "tail_share", "motor_time_constant_s", "judged_draws"}) {
    json.number(key);
  }
  json.optional_number("activity_max");
  json.object("noise", numbers_at({"heading_deg", "yaw_rate_degps", "speed_mps"}));
  const auto describe_times = numbers_at({"heading_s", "yaw_rate_s", "speed_s"});
  json.object("latency", describe_times);
  json.optional_object("noise_correlation", describe_times);
  describe_quantiles(json.object("quantiles"));
  if (auto by_scenario = json.optional_object("by_scenario")) {
    for (JsonObject& one : by_scenario->values()) describe_quantiles(one);
  }
  json.optional_object("open", read_open);
  // Older files have the nominal gains and the history of their search.
  json.optional_object("nominal", gains_from_json);
  json.optional_object("nominal_history", describe_history);
}

void describe_search(JsonObject& json) {
  json.optional_objects("active", [](JsonObject& one) {
    one.string("name");
    one.number("wider_gains", {.min = 0.0});
  });
  json.optional_object("as_good", [](JsonObject& as_good) {
    as_good.number("objective_share", {.min = 0.0, .max = 1.0});
    as_good.interval("mu");
    as_good.interval("speed_mu");
  });
  json.string("algorithm");
  json.string("stop_reason");
  // Rounding of the simulated runs: "fused" (with fused multiply-add) or "scalar" (without).
  json.optional_string("arithmetic");
  for (const char* key : {"evaluations", "simulated", "seed"}) json.number(key, kNonNegative);
  json.optional_object("history", describe_history);
}

void describe_goal(JsonObject& goal) {
  goal.object("at_most", [](JsonObject& limits) {
    for (const std::string& figure : run_figure_names()) limits.optional_number(figure, kPositive);
  });
  goal.number("share", kGoalShare);
  goal.boolean("soft");
  goal.choice("mode", kYawModeNames);
  goal.string("gains");
  for (const char* key : {"held", "runs"}) goal.number(key, kNonNegative);
  goal.interval("ci95");
  goal.choice("verdict", kGoalVerdictNames);
}

/// Describes the worst case under the key `name`, whose value is under the key `value`.
void describe_worst_case(JsonObject& mode, const char* name, const char* value) {
  mode.object(name, [&](JsonObject& json) {
    json.nullable_number(value);
    json.number("yaw_rate_degps", kNonNegative);
    json.object("parameters", [](JsonObject& parameters) {
      for (const ParameterInfo& parameter : parameter_table()) {
        parameters.optional_number(parameter.name, kNonNegative);
      }
    });
  });
}

/// Worst cases over the model's confidence set, by mode.
void describe_certificate(JsonObject& json) {
  json.string("set");  // examined set of plants: kCertifiedSet or kUncertifiedSet
  json.number("damping_min", {.min = -1.0, .max = 1.0});
  json.nullable_number("delay_margin_s", kNonNegative);
  json.string("method");
  json.optional_string("gains_sha256");  // not in older files
  for (const char* key :
       {"parameters", "degrees_of_freedom", "latency_s", "motor_time_constant_s"}) {
    json.number(key, kNonNegative);
  }
  json.interval("yaw_rate_degps");
  json.object("modes").values([](JsonObject& mode) {
    mode.optional_interval("yaw_rate_degps");  // absent in older files: that of all modes
    describe_worst_case(mode, "damping", "min");
    describe_worst_case(mode, "delay_margin", "min_s");
  });
}

/// TradeOff: Pareto front of the search, and named gains such as "tuned".
void describe_trade_off(JsonObject& json) {
  const auto describe_point = numbers_at({"settling_time_s", "control_variation"}, kNonNegative);
  json.objects("front", [&](JsonObject& point) {
    describe_point(point);
    if (point.has("heading")) gains_from_json(point);  // not in older files
  });
  json.object("gains").values(describe_point);
}

void describe_limits(JsonObject& json) {
  TuningLimits kept;
  limit_options(kept, [&](const char* key, const auto& value, const NumberRule& rule) {
    if constexpr (std::is_same_v<decltype(value), const double&>) {
      json.number(key, rule);
    } else {
      json.optional_number(key, rule);
    }
  });
}

void describe_baseline(JsonObject& json) {
  gains_from_json(json);
  json.optional_string("source");  // source of the baseline; absent: the paper's gains
  json.number("objective");
  describe_scores(json.object("metrics"));
}

void describe_tuning(JsonObject& json) {
  gains_from_json(json);
  json.optional_object("time_constants", numbers_at({"T1_s", "T2_s"}));
  json.optional_objects("constraints", describe_constraint);
  json.optional_object("examined", read_examined);
  json.optional_object("limits", describe_limits);
  json.optional_object("certificate", describe_certificate);
  json.optional_object("trade_off", describe_trade_off);
  json.optional_object("objective", describe_objective);
  if (auto metrics = json.optional_object("metrics")) describe_scores(*metrics);
  json.optional_object("search", describe_search);
  json.optional_object("robust", describe_robust);
  json.optional_objects("goals", describe_goal);
  json.optional_object("baseline", describe_baseline);
}

void describe_gains(JsonObject& json) {
  json.schema(kGainsSchema);
  read_provenance(json);
  json.ignore("version");
  describe_tuning(json);
  // Without `mode` and `modes`, the gains are for every mode of the vehicle.
  if (json.has("mode")) json.choice("mode", kYawModeNames);
  // Modes with their own gains.
  json.optional_object("modes", [](JsonObject& modes) {
    for (const YawMode mode : kYawModes) modes.optional_object(name_of(mode), describe_tuning);
  });
  json.ignore("sensitivity");  // of older files
  read_findings(json);
  json.reject_unknown_keys();
}

}  // namespace

std::string gains_schema() {
  return json_schema_text(kGainsSchema, "Gains and their origin", describe_gains);
}

}  // namespace awmr
