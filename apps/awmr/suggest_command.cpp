#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/identify/planning/suggest.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/simulate/simulate.h"
#include "commands.h"
#include "inputs.h"
#include "option_values.h"
#include "progress.h"

namespace awmr::cli {
namespace {

struct SuggestCommand {
  fs::path model;
  std::string parameter;
  std::optional<fs::path> gains;
  std::optional<fs::path> scenario;
  YawMode mode = YawMode::kCombined;
  int repeats = 3;
  std::optional<fs::path> output;
};

/// Largest number of trials on the printed sheet. The output file contains all trials.
constexpr std::size_t kSheetTrials = 8;

/// A metric of a simulated closed loop, such as the heading error. Its sensitivity to the vehicle's
/// parameters is computed with an unchanged controller.
struct LoopMetric {
  const char* name;
  std::optional<double> Metrics::*value;
};
constexpr LoopMetric kLoopMetrics[] = {{"heading_iae_degs", &Metrics::heading_iae_degs},
                                       {"overshoot_deg", &Metrics::overshoot_deg},
                                       {"speed_drop_mps", &Metrics::speed_drop_mps}};

/// Adds the metrics of the closed loop of `--gains` and `--scenario`; none if both are absent.
Status add_metrics(const SuggestCommand& command, const Model& model, SuggestOptions& options) {
  if (!command.gains && !command.scenario) return {};
  if (!command.gains || !command.scenario) {
    return input_error(ErrorCode::kMissing, "--gains",
                       "give --gains and --scenario together: they define the closed loop of the "
                       "metric");
  }
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  AWMR_RETURN_IF_ERROR(check_mode(model.vehicle, command.mode));
  AWMR_ASSIGN_OR_RETURN(const ModeGains gains,
                        read_gains_for(*command.gains, model.vehicle.sample_time_s));
  AWMR_ASSIGN_OR_RETURN(Scenario scenario, read_scenario(*command.scenario));
  scenario = equipped(model.vehicle, std::move(scenario));
  const Controller<double> controller =
      make_controller(plant, model.vehicle, gains.in(command.mode));
  const awmr::Run own = simulate(plant, controller, scenario, command.mode,
                                 {.sample_time_s = model.vehicle.sample_time_s, .substeps = {}});
  const Metrics of_own = metrics_of(own, scenario, controller);
  for (const LoopMetric& metric : kLoopMetrics) {
    if (!(of_own.*metric.value)) {
      if (command.parameter != metric.name) continue;
      return input_error(
          ErrorCode::kUnknownName, "--parameter",
          fmt::format("the simulation of {} in mode {} has no value of the metric {}; choose "
                      "another metric or scenario",
                      scenario.name, name_of(command.mode), metric.name));
    }
    options.metrics.push_back(
        {metric.name, [=, sample_time_s = model.vehicle.sample_time_s,
                       mode = command.mode](const Plant<double>& varied) {
           const awmr::Run run = simulate(varied, controller, scenario, mode,
                                          {.sample_time_s = sample_time_s, .substeps = {}});
           return (metrics_of(run, scenario, controller).*metric.value).value_or(0.0);
         }});
  }
  return {};
}

Result<Suggestion> suggest_with_progress(const Model& model, const SuggestOptions& options) {
  const Working working("evaluating trials");
  return suggest(model, options);
}

std::vector<fs::path> inputs_of(const SuggestCommand& command) {
  return all_paths(command.model, command.gains, command.scenario);
}

Result<std::string> document_of(const SuggestCommand& command, const Suggestion& suggestion) {
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> inputs, input_files(inputs_of(command)));
  const Provenance provenance{"suggest",
                              {{"parameter", command.parameter.empty() ? "all" : command.parameter},
                               {"repeats", std::to_string(command.repeats)}},
                              std::move(inputs)};
  return suggestion_text(suggestion, provenance);
}

Result<Outcome> execute(const SuggestCommand& command) {
  if (command.output) {
    AWMR_RETURN_IF_ERROR(check_output(*command.output, inputs_of(command)));
  }
  AWMR_ASSIGN_OR_RETURN(const Model model, read_model(command.model));
  SuggestOptions options;
  options.parameter = command.parameter;
  options.repeats = command.repeats;
  AWMR_RETURN_IF_ERROR(add_metrics(command, model, options));
  AWMR_ASSIGN_OR_RETURN(const Suggestion suggestion, suggest_with_progress(model, options));
  Outcome outcome{.summary = field_sheet(suggestion, kSheetTrials)};
  AWMR_ASSIGN_OR_RETURN(outcome.document, document_of(command, suggestion));
  AWMR_RETURN_IF_ERROR(write_document(command.output, outcome));
  return outcome;
}

}  // namespace

void add_suggest(CLI::App& app, Session& session) {
  auto held = std::make_shared<SuggestCommand>();
  CLI::App* sub =
      add_command(app, session, "suggest", "Rank the trials to record next, as a field sheet",
                  "awmr suggest --model model.json --parameter mass_norm -o suggest.json",
                  [held] { return execute(*held); });
  SuggestCommand& command = *held;
  add_file(*sub, "--model", command.model, "model.json from identify")->required();
  sub->add_option("--parameter", command.parameter,
                  "Parameter whose uncertainty the trials should reduce (default: all parameters "
                  "together). With --gains and --scenario, also a metric of the closed loop: "
                  "heading_iae_degs, overshoot_deg or speed_drop_mps");
  add_file(*sub, "--gains", command.gains,
           "gains.json of the controller, for a metric of --parameter");
  add_file(*sub, "--scenario", command.scenario,
           "scenario.json in which a metric of --parameter is computed");
  add_choice(*sub, "--mode", command.mode, kYawModeNames,
             "Yaw-control mode of the scenario "
             "(default combined)");
  sub->add_option("--repeats", command.repeats,
                  "Number of runs planned for each suggested surge, turning or coast-down trial "
                  "(default 3); a suggested log is planned once")
      ->check(within(1, 1000));
  add_file(*sub, "-o,--output", command.output, "suggest.json to write")
      ->check(not_standard_output());
}

}  // namespace awmr::cli
