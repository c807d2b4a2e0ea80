// Reads tune.json, writes gains.json.
#include "awmr/tune/tune_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "awmr/core/json.h"
#include "awmr/core/units.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/gains_json.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/tune_json.h"

namespace awmr {
namespace {

void read_weights(JsonObject json, ObjectiveWeights& weights) {
  weight_options(weights, ReadOption{json});
  if (!has_weight(weights)) {
    json.fault(ErrorCode::kOutOfRange, "itae", "all weights are 0: give at least one above 0");
  }
  json.reject_unknown_keys();
}

/// Raises the default numbers of draws to a multiple of the combinations of `open`.
void fit_draws_to(const UnmodelledVariation& open, TuneOptions& options) {
  const auto combinations = static_cast<int>(open.combinations());
  for (int* count : {&options.draws, &options.evaluation_draws}) {
    *count = (*count + combinations - 1) / combinations * combinations;
  }
}

void read_search(JsonObject& json, TuneOptions& options) {
  if (json.has("mode")) options.mode = json.choice("mode", kYawModeNames);
  if (json.has("form")) options.form = json.choice("form", kReachingFormNames);
  options.nominal = json.optional_boolean("nominal").value_or(options.nominal);
  options.adds_observer = !json.optional_boolean("no_observer").value_or(!options.adds_observer);
  if (json.has("goals")) options.evaluation_draws = kGoalDraws;
  if (auto open = json.optional_object("open")) {
    options.open = read_open(std::move(*open));
    fit_draws_to(options.open, options);
  }
  search_options(options, ReadOption{json});
  json.ignore("sensitivity");  // of older files
  if (const auto seed = json.optional_integer("seed", 0, 4'294'967'295L)) {
    options.seed = static_cast<std::uint64_t>(*seed);
  }
}

/// Reads the baseline: "pole-placement", "paper", or the path of a gains.json relative to
/// `directory`.
void read_baseline(JsonObject& json, const std::filesystem::path& directory, TuneConfig& config,
                   std::vector<Fault>& faults) {
  const std::optional<std::string> name = json.optional_string("baseline");
  if (!name) return;
  if (name->empty())
    return json.fault(ErrorCode::kBadName, "baseline",
                      "is empty; give \"pole-placement\", \"paper\" or the path of a gains.json");
  const bool is_file = *name != kPaperSource && *name != kPolePlacement;
  Result<std::optional<Baseline>> baseline =
      baseline_named(is_file ? directory / *name : std::filesystem::path(*name));
  if (!baseline) {
    const std::vector<Fault>& more = baseline.error().faults;
    faults.insert(faults.end(), more.begin(), more.end());
    return;
  }
  config.options.baseline = *std::move(baseline);
  if (config.options.baseline) config.options.baseline->source = *name;
  if (is_file) config.baseline_file = directory / *name;
}

ObserverSearch read_observer(JsonObject json) {
  ObserverSearch observer;
  observer_options(observer, ReadOption{json});
  json.reject_unknown_keys();
  return observer;
}

void read_goals(JsonObject& json, TuneOptions& options) {
  for (JsonObject& goal : json.optional_objects("goals")) {
    options.goals.push_back(read_goal(std::move(goal)));
  }
  if (options.goals.size() > kMaxGoals) {
    json.fault(ErrorCode::kTooLarge, "goals",
               fmt::format("{} goals are given, but at most {} are allowed; remove some",
                           options.goals.size(), kMaxGoals));
  }
  if (!options.goals.empty() && options.nominal) {
    json.fault(ErrorCode::kConflict, "goals",
               "goals need randomly drawn vehicles, which nominal disables; remove one of the two");
  }
  if (!options.goals.empty() && options.evaluation_draws == 0) {
    json.fault(ErrorCode::kConflict, "judged_draws",
               "goals are evaluated on newly drawn vehicles, so their number has to be above 0; "
               "increase it, or remove the goals");
  }
}

/// Reads the scenarios, whose paths are relative to `directory`. Their faults are added to
/// `faults`.
void read_scenarios(JsonObject& json, const std::filesystem::path& directory, TuneConfig& config,
                    std::vector<Fault>& faults) {
  if (!json.has("scenarios")) return;
  const std::vector<std::string> names = json.strings("scenarios");
  for (const std::string& name : names) {
    const std::filesystem::path path = directory / name;
    Result<Scenario> scenario = read_scenario(path);
    if (!scenario) {
      const std::vector<Fault>& more = scenario.error().faults;
      faults.insert(faults.end(), more.begin(), more.end());
      continue;
    }
    config.options.scenarios.push_back(std::move(*scenario));
    config.scenario_files.push_back(path);
  }
  if (names.empty()) {
    json.fault(ErrorCode::kMissing, "scenarios",
               "an empty list; leave the key out for the default scenarios");
  }
}

Json optional_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json score_json(const ModeScore& score) {
  const Metrics& m = score.metrics;
  return {{"objective", score.objective},
          {"completed", m.completed},
          {"settling_time_s", optional_json(m.settling_time_s)},
          {"overshoot_deg", optional_json(m.overshoot_deg)},
          {"heading_iae_degs", optional_json(m.heading_iae_degs)},
          {"heading_itae_degs2", optional_json(m.heading_itae_degs2)},
          {"speed_itae_m_s", m.speed_itae_m_s},
          {"speed_drop_mps", optional_json(m.speed_drop_mps)},
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

Json interval_json(const Interval& interval) { return {interval.lo, interval.hi}; }

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
      "w_i; x0: the baseline's metric in the same mode and scenario; f: a floor below which "
      "differences do not matter";
  if (std::ranges::any_of(options.goals, &TuningGoal::is_soft)) {
    json["formula"] =
        json["formula"].get<std::string>() +
        "; plus max(0, q - 1) for each soft goal and mode, q: the goal's quantile over "
        "the draws of the largest ratio of a metric to its limit";
  }
  json["terms"] = Json::array();
  for (const ObjectiveTerm& term : kObjectiveTerms) {
    json["weights"][term.name] = weights.*term.weight;
    json["terms"].push_back({{"name", term.name}, {"figure", term.figure}, {"floor", term.floor}});
  }
  return json;
}

constexpr std::string_view kTuneSchema = "awmr.tune/1";

/// Reads tune.json. Paths in it are relative to `directory`. Faults of the files that it names are
/// added to `faults`.
TuneConfig config_from_json(JsonObject& object, const std::filesystem::path& directory,
                            std::vector<Fault>& faults) {
  TuneConfig config;
  object.schema(kTuneSchema);
  read_search(object, config.options);
  if (auto weights = object.optional_object("weights")) {
    read_weights(*weights, config.options.weights);
  }
  if (auto bounds = object.optional_object("bounds")) {
    bound_options(config.options.bounds, ReadOption{*bounds});
    bounds->reject_unknown_keys();
  }
  if (auto observer = object.optional_object("observer")) {
    config.options.observer = read_observer(std::move(*observer));
    if (!config.options.adds_observer) {
      object.fault(ErrorCode::kConflict, "no_observer",
                   "forbids an observer, but `observer` asks for one; remove one of the two");
    }
  }
  if (auto limits = object.optional_object("limits")) {
    config.options.limits = read_limits(std::move(*limits));
  }
  read_goals(object, config.options);
  read_baseline(object, directory, config, faults);
  read_scenarios(object, directory, config, faults);
  object.reject_unknown_keys();
  return config;
}

}  // namespace

Result<std::optional<Baseline>> baseline_named(const std::filesystem::path& name) {
  if (name == kPolePlacement) return std::nullopt;
  if (name == kPaperSource) return Baseline{kPaperGains, kPaperSource};
  AWMR_ASSIGN_OR_RETURN(const Gains<double> gains, read_gains(name));
  return Baseline{gains, name.string()};
}

Result<TuneConfig> read_tune_config(const std::filesystem::path& path) {
  AWMR_ASSIGN_OR_RETURN(const Json json, read_json_file(path));
  std::vector<Fault> faults;
  JsonObject object(json, path.string(), "", faults);
  TuneConfig config = config_from_json(object, path.parent_path(), faults);
  if (!faults.empty()) return input_errors(std::move(faults));
  config.options.file = path.string();
  return config;
}

std::string tune_schema() {
  return json_schema_text(kTuneSchema, "Options of a search for gains", [](JsonObject& json) {
    std::vector<Fault> ignored;
    config_from_json(json, "", ignored);
  });
}

std::string gains_text(const Tuning& tuning, const TuneOptions& options,
                       const Provenance& provenance) {
  Json json;
  json["schema"] = kGainsSchema;
  json.update(gains_to_json(tuning.gains));
  if (options.mode) json["mode"] = name_of(*options.mode);
  json["time_constants"] = {{"T1_s", tuning.gains.heading.sliding_time_constant_s()},
                            {"T2_s", tuning.gains.heading.reaching_time_constant_s()}};
  json["constraints"] = constraints_json(tuning.constraints);
  json["limits"] = limits_json(tuning.limits);
  json["examined"] = {{"speed_mps", tuning.examined.speed_mps},
                      {"step_deg", degrees(tuning.examined.step_rad)},
                      {"yaw_rate_degps", degrees(tuning.examined.yaw_rate_radps)}};
  if (tuning.certificate) json["certificate"] = certificate_json(*tuning.certificate);
  if (!tuning.trade_off.named.empty()) json["trade_off"] = trade_off_json(tuning.trade_off);
  json["objective"] = objective_json(tuning, options);
  json["objective"]["held_out"] = {{"value", tuning.held_out_objective},
                                   {"metrics", scores_json(tuning.held_out_scores)}};
  json["metrics"] = scores_json(tuning.scores);
  json["search"] = {{"algorithm", tuning.algorithm},
                    {"evaluations", tuning.evaluations},
                    {"simulated", tuning.simulated},
                    {"seed", tuning.seed},
                    {"arithmetic", tuning.arithmetic},
                    {"active", active_json(tuning.active)},
                    {"as_good",
                     {{"objective_share", kIndifferent},
                      {"mu", interval_json(tuning.mu_as_good)},
                      {"speed_mu", interval_json(tuning.speed_mu_as_good)}}},
                    {"stop_reason", tuning.stop_reason},
                    {"history", history_json(tuning.history)}};
  if (tuning.robust) json["robust"] = robust_json(*tuning.robust, options);
  if (!options.goals.empty()) json["goals"] = goals_json(tuning.robust->goals);
  Json baseline = gains_to_json(tuning.baseline.gains);
  baseline["source"] = tuning.baseline.source;
  baseline["objective"] = tuning.baseline_objective;
  baseline["metrics"] = scores_json(tuning.baseline_scores);
  json["baseline"] = std::move(baseline);
  put_provenance(json, provenance);
  return to_text(json);
}

}  // namespace awmr
