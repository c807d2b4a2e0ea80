#include "awmr/tune/tune_file.h"

#include <fmt/format.h>

#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/json/json.h"
#include "awmr/core/option_text.h"
#include "awmr/model/gains_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/tune_json.h"

namespace awmr {
namespace {

void read_weights(JsonObject& root, ObjectiveWeights& weights) {
  auto json = root.optional_object("weights");
  if (!json) return;
  weight_options(weights, ReadOption{*json});
  if (!has_weight(weights)) {
    root.fault(ErrorCode::kOutOfRange, "weights", "all weights are 0: give at least one above 0");
  }
  json->reject_unknown_keys();
}

/// Rounds the default numbers of draws up to a multiple of the number of combinations of `open`.
void fit_draws_to(const UnmodelledVariation& open, TuneOptions& options) {
  const auto combinations = static_cast<int>(open.combinations());
  for (int* count : {&options.draws, &options.evaluation_draws}) {
    *count = (*count + combinations - 1) / combinations * combinations;
  }
}

/// Rejects options about drawn vehicles if `nominal` is set, except 0 draws.
void reject_draws(JsonObject& json, const TuneOptions& options) {
  if (!options.nominal) return;
  for (const auto& [key, conflicts] :
       {std::pair("draws", options.draws != 0),
        std::pair("judged_draws", options.evaluation_draws != 0), std::pair("tail_share", true)}) {
    if (!conflicts || !json.has(key)) continue;
    json.fault(
        ErrorCode::kConflict, key,
        "this key needs randomly drawn vehicles, which `nominal` disables; remove one of the two");
  }
}

void read_search(JsonObject& json, TuneOptions& options) {
  if (json.has("mode")) options.mode = json.choice("mode", kYawModeNames);
  if (json.has("form")) options.form = json.choice("form", kReachingFormNames);
  options.one_set = json.optional_boolean("one_set").value_or(options.one_set);
  if (options.one_set && options.mode) {
    json.fault(ErrorCode::kConflict, "one_set",
               "one set of gains for all modes, but `mode` tunes for one mode only; remove one of "
               "the two");
  }
  options.nominal = json.optional_boolean("nominal").value_or(options.nominal);
  options.adds_observer = !json.optional_boolean("no_observer").value_or(!options.adds_observer);
  options.allows_unsettled =
      json.optional_boolean("allow_unsettled").value_or(options.allows_unsettled);
  if (json.has("goals")) options.evaluation_draws = kGoalDraws;
  if (auto open = json.optional_object("open", read_open)) {
    options.open = *std::move(open);
    fit_draws_to(options.open, options);
  }
  search_options(options, ReadOption{json});
  reject_draws(json, options);
  json.ignore("sensitivity");  // of older files
  if (const auto seed = json.optional_integer("seed", 0, 4'294'967'295L)) {
    options.seed = static_cast<std::uint64_t>(*seed);
  }
}

/// Reads the baseline: "pole-placement", "paper", or a path relative to `directory`.
void read_baseline(JsonObject& json, const std::filesystem::path& directory, TuneConfig& config,
                   std::vector<Fault>& faults) {
  const std::optional<std::string> name = json.optional_string("baseline");
  if (!name) return;
  if (name->empty())
    return json.fault(
        ErrorCode::kBadName, "baseline",
        "the baseline is empty; give \"pole-placement\", \"paper\" or the path of a gains.json");
  const bool is_file = *name != kPaperSource && *name != kPolePlacement;
  Result<std::optional<Baseline>> baseline =
      baseline_named(is_file ? directory / *name : std::filesystem::path(*name));
  if (!baseline) {
    const std::vector<Fault>& more = baseline.error().faults;
    append(faults, more);
    return;
  }
  config.options.baseline = *std::move(baseline);
  if (config.options.baseline) config.options.baseline->source = *name;
  if (is_file) config.baseline_file = directory / *name;
}

ObserverSearch read_observer(JsonObject& json) {
  ObserverSearch observer;
  observer_options(observer, ReadOption{json});
  return observer;
}

TuningGoal read_goal(JsonObject& json) {
  TuningGoal goal;
  json.object("at_most", [&](JsonObject& limits) {
    for (const std::string& figure : run_figure_names()) {
      if (const auto most = limits.optional_number(figure, kGoalLimit)) {
        goal.at_most.push_back({figure, *most});
      }
    }
  });
  if (json.size("at_most") == 0) {
    json.fault(ErrorCode::kMissing, "at_most",
               "this goal contains no metric; give at least one with its limit");
  }
  goal.share = json.optional_number("share", kGoalShare).value_or(goal.share);
  if (json.has("mode")) goal.mode = json.choice("mode", kYawModeNames);
  goal.is_soft = json.optional_boolean("soft").value_or(false);
  return goal;
}

void read_goals(JsonObject& json, TuneOptions& options) {
  options.goals = json.optional_objects("goals", read_goal);
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

/// Reads the scenarios. Their paths are relative to `directory`. Adds their faults to `faults`.
void read_scenarios(JsonObject& json, const std::filesystem::path& directory, TuneConfig& config,
                    std::vector<Fault>& faults) {
  if (!json.has("scenarios")) return;
  for (const std::string& name : json.strings("scenarios")) {
    const std::filesystem::path path = directory / name;
    Result<Scenario> scenario = read_scenario(path);
    if (!scenario) {
      const std::vector<Fault>& more = scenario.error().faults;
      append(faults, more);
      continue;
    }
    config.options.scenarios.push_back(std::move(*scenario));
    config.scenario_files.push_back(path);
  }
  if (json.size("scenarios") == 0) {
    json.fault(ErrorCode::kMissing, "scenarios",
               "the list is empty; leave the key out for the default scenarios");
  }
}

constexpr std::string_view kTuneSchema = "awmr.tune/1";

/// Reads tune.json. Paths in tune.json are relative to `directory`. Adds the faults of the files
/// that tune.json names to `faults`.
TuneConfig config_from_json(JsonObject& object, const std::filesystem::path& directory,
                            std::vector<Fault>& faults) {
  TuneConfig config;
  object.schema(kTuneSchema);
  read_search(object, config.options);
  read_weights(object, config.options.weights);
  object.optional_object("bounds", [&](JsonObject& bounds) {
    bound_options(config.options.bounds, ReadOption{bounds});
  });
  config.options.observer = object.optional_object("observer", read_observer);
  if (config.options.observer && !config.options.adds_observer) {
    object.fault(
        ErrorCode::kConflict, "no_observer",
        "this key forbids an observer, but `observer` requests one; remove one of the two");
  }
  if (auto limits = object.optional_object("limits", read_limits)) config.options.limits = *limits;
  read_goals(object, config.options);
  read_baseline(object, directory, config, faults);
  read_scenarios(object, directory, config, faults);
  object.reject_unknown_keys();
  for (const std::string& key : object.keys()) config.keys.insert(key);
  return config;
}

}  // namespace

Result<std::optional<Baseline>> baseline_named(const std::filesystem::path& name) {
  if (name == kPolePlacement) return std::nullopt;
  if (name == kPaperSource) return Baseline{kPaperGains, kPaperSource};
  AWMR_ASSIGN_OR_RETURN(const ModeGains gains, read_mode_gains(name));
  return Baseline{gains, name.string()};
}

Status check_observer_choice(std::optional<bool> observer, const TuneOptions& options,
                             const std::string& place) {
  if (observer == true && !options.adds_observer) {
    return input_error(ErrorCode::kConflict, place,
                       "requests an observer, but the configuration forbids it (no_observer); "
                       "remove one of the two");
  }
  if (observer == false && options.observer) {
    return input_error(ErrorCode::kConflict, place,
                       "forbids an observer, but the configuration requests one (observer); remove "
                       "one of the two");
  }
  return {};
}

Status check_mode_choice(std::optional<YawMode> mode, bool one_set, const TuneOptions& options) {
  if (mode && options.one_set) {
    return input_error(ErrorCode::kConflict, option_text("mode"),
                       "tunes for one mode only, but the configuration requests one set of gains "
                       "for all modes (one_set); remove one of the two");
  }
  if (one_set && options.mode) {
    return input_error(ErrorCode::kConflict, option_text("one_set"),
                       "requests one set of gains for all modes, but the configuration tunes for "
                       "one mode only (mode); remove one of the two");
  }
  return {};
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

}  // namespace awmr
