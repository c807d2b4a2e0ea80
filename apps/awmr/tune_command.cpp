#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "awmr/core/file.h"
#include "awmr/core/option_text.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/tune_file.h"
#include "awmr/tune/tune_findings.h"
#include "commands.h"
#include "gains_origin.h"
#include "inputs.h"
#include "option_values.h"
#include "progress.h"
#include "tune_text.h"

namespace awmr::cli {
namespace {

Result<Tuning> tune_with_progress(const Model& model, TuneOptions options) {
  Working working("searching for gains");
  std::size_t before = 0;
  options.progress = [&](std::size_t done, std::size_t total) {
    if (done < before) working.doing("searching for gains again");
    before = done;
    working(done, total);
  };
  options.notice = print_notice;
  return tune(model, options);
}

/// Checks that no option contradicts tune.json. Errors (input, `conflict`): those of
/// check_observer_choice() and check_mode_choice(); `--draws`, with the key `nominal`.
Status check_against(const TuneConfig& config, const TuneCommand& command) {
  const TuneOptions& options = config.options;
  AWMR_RETURN_IF_ERROR(check_observer_choice(
      command.observer, options, command.observer == false ? "--no-observer" : "--observer"));
  AWMR_RETURN_IF_ERROR(check_mode_choice(command.mode, command.one_set, options));
  if (command.draws && options.nominal) {
    return input_error(
        ErrorCode::kConflict, "--draws",
        "the configuration (--config) sets nominal, which draws no vehicles; remove --draws or "
        "nominal");
  }
  return {};
}

/// Returns the note `option-overrides` for each option that overrides a value in tune.json. With
/// `--nominal`, also for each key about drawn vehicles, which then has no effect.
std::vector<Finding> overridden_keys(const TuneConfig& config, const TuneCommand& command) {
  std::vector<Finding> findings;
  const auto note = [&](const char* key, const std::string& before, const std::string& now) {
    if (!config.keys.contains(key) || before == now) return;
    findings.push_back(
        {command.config->string(), 0, Severity::kNote, "option-overrides",
         fmt::format("{} {} replaces {} of this file", option_text(key), now, before)});
  };
  const TuneOptions& options = config.options;
  if (command.mode) {
    note("mode", std::string(options.mode ? name_of(*options.mode) : ""),
         std::string(name_of(*command.mode)));
  }
  const auto note_flag = [&](const char* option, bool is_given, const char* key) {
    if (!is_given || !config.keys.contains(key)) return;
    findings.push_back({command.config->string(), 0, Severity::kNote, "option-overrides",
                        fmt::format("{} replaces {} of this file", option_text(option), key)});
  };
  note_flag("one_set", command.one_set && !options.one_set, "one_set");
  note_flag("allow_unsettled", command.allow_unsettled && !options.allows_unsettled,
            "allow_unsettled");
  note_flag("nominal", command.nominal && !options.nominal, "nominal");
  note_flag("no_observer", command.observer == false && options.adds_observer, "no_observer");
  if (command.draws)
    note("draws", fmt::format("{}", options.draws), fmt::format("{}", *command.draws));
  if (command.baseline) {
    note("baseline", options.baseline ? options.baseline->source : std::string(kPolePlacement),
         command.baseline->string());
  }
  for (const char* key : {"draws", "judged_draws", "tail_share"}) {
    if (!command.nominal || !config.keys.contains(key)) continue;
    findings.push_back({command.config->string(), 0, Severity::kNote, "option-overrides",
                        fmt::format("{} draws no vehicles, so {} of this file has no effect",
                                    option_text("nominal"), key)});
  }
  return findings;
}

/// tune.json with the command-line options, which override it.
struct ChosenConfig {
  TuneConfig config;
  std::vector<Finding> findings;  ///< overridden_keys()
};

/// Reads the tune.json of `--config`. Then applies the other command-line options, which override
/// the values in that file. `--allocation` also changes `model`.
Result<ChosenConfig> config_of(const TuneCommand& command, Model& model) {
  TuneConfig config;
  if (command.config) {
    AWMR_ASSIGN_OR_RETURN(config, read_tune_config(*command.config));
  }
  AWMR_RETURN_IF_ERROR(check_against(config, command));
  const std::vector<Finding> findings = overridden_keys(config, command);
  TuneOptions& options = config.options;
  choose_observer(command.observer, options);
  if (command.mode) options.mode = command.mode;
  if (options.scenarios.empty()) {
    options.has_default_scenarios = true;
    AWMR_ASSIGN_OR_RETURN(options.scenarios,
                          default_tuning_scenarios(model, options, command.heading_rate_limit));
  }
  choose(command.allocation, model, options.scenarios);
  AWMR_RETURN_IF_ERROR(limit_heading_rate(command.heading_rate_limit, model, options.scenarios));
  if (command.nominal) options.nominal = true;
  if (command.one_set) options.one_set = true;
  if (command.allow_unsettled) options.allows_unsettled = true;
  if (command.draws) options.draws = *command.draws;
  if (command.baseline) {
    AWMR_ASSIGN_OR_RETURN(options.baseline, baseline_named(*command.baseline));
    config.baseline_file.reset();
    if (options.baseline && options.baseline->source != kPaperSource) {
      config.baseline_file = *command.baseline;
    }
  }
  return ChosenConfig{std::move(config), findings};
}

std::vector<fs::path> inputs_of(const TuneCommand& command, const TuneConfig& config) {
  return all_paths(command.model, command.config, config.baseline_file, config.scenario_files);
}

Result<Provenance> provenance_of(const TuneCommand& command, const std::vector<fs::path>& paths) {
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> inputs, input_files(paths, command.names));
  NamedOptions options;
  describe_allocation(command.allocation, options);
  if (command.nominal) options.emplace_back("nominal", "true");
  if (command.observer) {
    options.emplace_back(*command.observer ? "observer" : "no-observer", "true");
  }
  if (command.baseline) options.emplace_back("baseline", command.baseline->string());
  if (command.mode) options.emplace_back("mode", std::string(name_of(*command.mode)));
  if (command.one_set) options.emplace_back("one-set", "true");
  if (command.allow_unsettled) options.emplace_back("allow-unsettled", "true");
  if (command.draws) options.emplace_back("draws", std::to_string(*command.draws));
  describe_rate(command.heading_rate_limit, options);
  return Provenance{"tune", std::move(options), std::move(inputs)};
}

/// Adds the options of the search; returns `--nominal`.
CLI::Option* add_search(CLI::App& sub, TuneCommand& command) {
  auto* nominal = sub.add_flag("--nominal", command.nominal,
                               "Tune for the model's own parameter values only, without random "
                               "parameters, sensor noise, latency or motor lag");
  auto* observer = sub.add_flag_callback(
      "--observer", [&command] { command.observer = true; },
      "Also tune a disturbance observer, for constant disturbances such as a slope or unequal "
      "motors (default: only if fewer than 95 % of the runs settle without it)");
  sub.add_flag_callback(
         "--no-observer", [&command] { command.observer = false; },
         "Tune no disturbance observer, even if runs do not settle without one")
      ->excludes(observer);
  sub.add_option("--baseline", command.baseline,
                 "Gains for comparison, whose objective is 1 by definition: pole-placement "
                 "(default), paper or a gains.json")
      ->type_name("NAME|FILE");
  auto* one_set =
      sub.add_flag("--one-set", command.one_set,
                   "Tune one set of gains for all modes (default: a set for each mode if gains for "
                   "one mode alone settle much faster)");
  sub.add_flag("--allow-unsettled", command.allow_unsettled,
               "Write gains.json even if in some mode the vehicle never settles with the gains "
               "(default: exit code 1, with the changes that let runs settle)");
  add_choice(sub, "--mode", command.mode, kYawModeNames,
             "Tune for this mode only (default: for all modes)")
      ->excludes(one_set);
  return nominal;
}

void add_draws(CLI::App& sub, TuneCommand& command, CLI::Option* nominal) {
  sub.add_option("--draws", command.draws,
                 "Number of vehicles drawn from the model's covariance to tune for (default 32)")
      ->check(within(static_cast<int>(kDraws.min), static_cast<int>(kDraws.max)))
      ->excludes(nominal);
}

}  // namespace

Result<Outcome> execute(const TuneCommand& command) {
  AWMR_ASSIGN_OR_RETURN(Model model, read_model(command.model));
  AWMR_ASSIGN_OR_RETURN(const ChosenConfig chosen, config_of(command, model));
  const TuneConfig& config = chosen.config;
  const std::vector<fs::path> inputs = inputs_of(command, config);
  AWMR_RETURN_IF_ERROR(check_output(command.output, inputs));
  AWMR_ASSIGN_OR_RETURN(const Provenance provenance, provenance_of(command, inputs));
  AWMR_ASSIGN_OR_RETURN(const Tuning tuning, tune_with_progress(model, config.options));
  std::vector<Finding> findings = chosen.findings;
  std::ranges::move(tune_findings(model, config.options, tuning), std::back_inserter(findings));
  if (config.baseline_file) {
    AWMR_RETURN_IF_ERROR(
        note_other_model(*config.baseline_file, command.model, findings, config.options.mode));
  }
  Outcome outcome{.summary = tuning_summary(tuning, config.options),
                  .details = tuning_details(tuning),
                  .closing = fmt::format("wrote {}\n", command.output.string()),
                  .brief = gains_table(tuning),
                  .findings = std::move(findings),
                  .document = gains_text(tuning, config.options, provenance),
                  .written = {command.output}};
  put_findings_into_document(outcome);
  AWMR_RETURN_IF_ERROR(write_file(command.output, outcome.document, check_gains_text));
  return outcome;
}

void add_tune(CLI::App& app, Session& session) {
  auto command = std::make_shared<TuneCommand>();
  CLI::App* sub = add_command(app, session, "tune",
                              "Tune the gains of the heading and speed controllers, so that the "
                              "sliding variable decays faster (time constant T2) than the errors "
                              "(T1)",
                              "awmr tune --model model.json -o gains.json",
                              [command] { return execute(*command); });
  add_file(*sub, "--model", command->model, "model.json from identify")->required();
  add_file(*sub, "--config", command->config,
           "tune.json, with any of the keys mode, one_set, form, margin, limits, baseline, "
           "weights, goals, open, observer, no_observer, allow_unsettled, global_evaluations, "
           "local_evaluations, seed, scenarios");
  CLI::Option* nominal = add_search(*sub, *command);
  add_draws(*sub, *command, nominal);
  add_allocation(*sub, command->allocation);
  add_heading_rate_limit(*sub, command->heading_rate_limit,
                         "scenarios of --config have no further limit; one of the two default "
                         "scenarios is limited to the highest measured yaw rate");
  add_output(*sub, command->output, "gains.json to write");
}

}  // namespace awmr::cli
