#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <type_traits>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/file.h"
#include "awmr/core/json/json_document.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/trials/checks/log_consistency.h"
#include "awmr/trials/trial_columns.h"
#include "commands.h"
#include "gains_origin.h"
#include "identify_options.h"
#include "identify_words.h"
#include "inputs.h"
#include "option_values.h"
#include "progress.h"

namespace awmr::cli {
namespace {

Result<Validation> validate_with_progress(const Model& model, const std::optional<ModeGains>& gains,
                                          ValidateOptions options) {
  Working working("checking the claims");
  options.progress = [&](std::size_t done, std::size_t total) { working(done, total); };
  return validate(model, gains, options);
}

/// Returns the verdict, and for the paper's vehicle its claims that are and are not reproduced.
std::string brief_of(const Validation& validation, const Vehicle& vehicle) {
  if (!is_vehicle_of_paper(vehicle)) return fmt::format("  {}\n", validation.verdict);
  std::vector<std::string> reproduced;
  std::vector<std::string> others;
  for (const Claim& claim : validation.claims) {
    (claim.reproduced ? reproduced : others).push_back(claim.id);
  }
  return fmt::format("  {}\n  claims reproduced: {}; not reproduced: {}\n", validation.verdict,
                     fmt::join(reproduced, " "),
                     others.empty() ? "none" : fmt::format("{}", fmt::join(others, " ")));
}

/// Reads the logs of the command and calls `evaluate` for each run; a log can contain several runs.
/// Returns the results of all runs.
template <class Evaluate>
auto evaluate_logs(const ValidateCommand& command, const Vehicle& vehicle, const Evaluate& evaluate,
                   std::vector<Finding>& findings)
    -> Result<
        std::vector<typename decltype(evaluate(std::declval<const DrivingLog&>()))::value_type>> {
  using Evaluated = typename decltype(evaluate(std::declval<const DrivingLog&>()))::value_type;
  AWMR_ASSIGN_OR_RETURN(const TrialOptions options, with_vehicle_columns(command.trials, vehicle));
  std::vector<std::size_t> used;
  const auto evaluate_runs = [&](const fs::path& path) -> Result<std::vector<Evaluated>> {
    AWMR_ASSIGN_OR_RETURN(const std::vector<DrivingLog> runs, read_logs(path, options, findings));
    std::vector<Evaluated> evaluated;
    for (const DrivingLog& log : runs) {
      append(used, log.mapped);
      AWMR_RETURN_IF_ERROR(check_consistency(log, path.string(), vehicle, options, findings));
      AWMR_ASSIGN_OR_RETURN(Evaluated one, evaluate(log));
      evaluated.push_back(std::move(one));
    }
    return evaluated;
  };
  AWMR_ASSIGN_OR_RETURN(const auto by_file, read_each(command.logs, evaluate_runs));
  if (!command.other_columns) AWMR_RETURN_IF_ERROR(check_mappings(options, used, command.logs));
  std::vector<Evaluated> all;
  for (const auto& runs : by_file) append(all, runs);
  return all;
}

/// Evaluates the logs. If no scenario is given, the logs are compared with the motion that the
/// model predicts. If one is given, they are compared with simulated drives of this scenario under
/// the controller.
Status add_evaluated_logs(const ValidateCommand& command, const Model& model,
                          const std::optional<ModeGains>& gains, Validation& validation,
                          std::vector<Finding>& findings) {
  if (!command.scenario) {
    std::vector<DrivingLog> read;
    const auto by_model = [&](const DrivingLog& log) {
      if (command.tyres) read.push_back(log);
      return validate_log(log, model, command.horizon_s, command.log_tolerance);
    };
    AWMR_ASSIGN_OR_RETURN(auto logs, evaluate_logs(command, model.vehicle, by_model, findings));
    add_logs(validation, std::move(logs), command.log_tolerance);
    if (!command.tyres) return {};
    const Working working("fitting tyres");
    AWMR_ASSIGN_OR_RETURN(validation.tyres, fit_tyres(read, model, findings));
    validation.passed = validation.passed && validation.tyres.has_value();
    return {};
  }
  AWMR_ASSIGN_OR_RETURN(const Scenario scenario, read_scenario(*command.scenario));
  const auto under_control = [&](const DrivingLog& log) {
    return accept_drive(log, model, *gains, scenario, command.acceptance);
  };
  AWMR_ASSIGN_OR_RETURN(auto drives,
                        evaluate_logs(command, model.vehicle, under_control, findings));
  add_drives(validation, std::move(drives));
  return {};
}

/// Returns the gains in the file of `--gains`. Without that option, returns the paper's gains if
/// claims are checked, else none.
Result<std::optional<ModeGains>> gains_of(const ValidateCommand& command, const Model& model) {
  if (command.gains) return read_gains_for(*command.gains, model.vehicle.sample_time_s);
  if (command.claims) return kPaperGains;
  return std::nullopt;
}

std::vector<fs::path> inputs_of(const ValidateCommand& command) {
  return all_paths(command.model, command.gains, command.logs, command.scenario);
}

Status check_outputs(const ValidateCommand& command) {
  AWMR_RETURN_IF_ERROR(check_output(command.output, inputs_of(command)));
  if (!command.claims_table) return {};
  return check_output(*command.claims_table, inputs_of(command));
}

Result<Provenance> provenance_of(const ValidateCommand& command) {
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> inputs,
                        input_files(inputs_of(command), command.names));
  NamedOptions options;
  describe_allocation(command.allocation, options);
  options.emplace_back("tolerance", format_number(command.validate.tolerance));
  describe_parts(command.trials, options);
  if (command.tyres) options.emplace_back("tyres", "true");
  if (command.scenario) {
    options.emplace_back("mode", std::string(name_of(command.acceptance.mode)));
    options.emplace_back("draws", std::to_string(command.acceptance.draws));
    options.emplace_back("seed", std::to_string(command.acceptance.seed));
  }
  return Provenance{"validate", std::move(options), std::move(inputs)};
}

/// Adds the warning `log-of-the-fit` for each log that the model was fitted to: its SHA-256 is the
/// SHA-256 of an input of the model.
void note_fitted_logs(const Model& model, const Provenance& provenance,
                      std::vector<Finding>& findings) {
  for (const InputFile& input : provenance.inputs) {
    const bool is_fitted =
        std::ranges::any_of(model.record.provenance.inputs,
                            [&](const InputFile& fitted) { return fitted.sha256 == input.sha256; });
    if (!is_fitted) continue;
    findings.push_back({input.name, 0, Severity::kWarning, "log-of-the-fit",
                        "the model was fitted to this log, so the result shows how well it fits, "
                        "not how well it predicts. Validate on a log that was not fitted"});
  }
}

/// Returns the claims if requested, else the verdict and the prediction errors of each log.
std::string summary_of(const ValidateCommand& command, const Validation& validation,
                       const Vehicle& vehicle) {
  if (command.claims) return claims_table(validation.claims) + validation.verdict + '\n';
  const char* const title = validation.trials.empty()
                                ? ""
                                : "on the trials to which the model was fitted, not on new data\n";
  std::string text = title + brief_of(validation, vehicle) + logs_table(validation);
  for (const Acceptance& drive : validation.drives) text += acceptance_table(drive);
  return text;
}

void add_model_options(CLI::App& sub, ValidateCommand& command) {
  add_file(sub, "--model", command.model, "model.json from identify")->required();
  add_file(sub, "--gains", command.gains,
           "gains.json: also check the paper's claims about the closed loop");
  sub.add_option("--tolerance", command.validate.tolerance,
                 "Largest accepted relative error (RMS) of the predictions for one kind of trial "
                 "(default 0.15)")
      ->check(within(1e-9, 1e6));
}

void add_log_options(CLI::App& sub, ValidateCommand& command, ColumnWords& columns,
                     std::vector<std::string>& excluded) {
  add_file(sub, "--log", command.logs,
           "CSV of a driving log, preferably not used in the fit; may be repeated");
  sub.add_option("--horizon", command.horizon_s,
                 "Length of the windows in which logs are predicted, s; each prediction starts "
                 "from the measured state (default 10)")
      ->check(within(0.01, 1e6));
  sub.add_option("--log-tolerance", command.log_tolerance,
                 "Largest accepted normalised RMS prediction error (NRMSE) of a channel over a "
                 "window (default 0.3)")
      ->check(within(1e-9, 1e6));
  sub.add_flag("--tyres", command.tyres,
               "Also fit the tyres of the four-wheel model (friction, cornering stiffness) to "
               "the logs. Parts of the logs that were not fitted then show whether this model or "
               "the 3-DOF model predicts better")
      ->needs("--log");
  add_end_options(sub, command.trials, excluded);
  sub.add_flag("--as-is", command.trials.as_is,
               "Accept logs that appear to have wrong units or signs, or left and right exchanged");
  sub.add_option("--column", columns.columns, kColumnHelp);
  add_file(sub, "--columns-file", columns.file, kColumnsFileHelp);
}

void add_drive_options(CLI::App& sub, ValidateCommand& command) {
  auto* scenario = add_file(sub, "--scenario", command.scenario,
                            "The logs are drives of this scenario with the gains; compare them "
                            "with the predicted distribution (parameter uncertainty, noise, lags)");
  scenario->needs("--log")->needs("--gains")->excludes("--tyres");
  add_choice(sub, "--mode", command.acceptance.mode, kYawModeNames,
             "Yaw-control mode of the drives (default combined)")
      ->needs(scenario);
  sub.add_option("--draws", command.acceptance.draws, "Number of predicted drives (default 200)")
      ->check(within(39, 10000))
      ->needs(scenario);
  sub.add_option("--seed", command.acceptance.seed, "Random seed of the draws (default 1)")
      ->check(within<std::uint64_t>(0, kAnySeed))
      ->needs(scenario);
  sub.add_option("--from", command.acceptance.from_s,
                 "Use each log from this time on, s. With --scenario, this is the time in the log "
                 "at which the scenario begins (default: first row with a non-zero command)")
      ->check(within(-kMaxTime_s, kMaxTime_s));
}

void add_claims_options(CLI::App& sub, ValidateCommand& command) {
  auto* claims =
      sub.add_flag("--claims", command.claims,
                   "Check the paper's fourteen claims, with the paper's gains if --gains "
                   "is absent. For each claim, print the result, the criterion, and the "
                   "settings that decide the result but are not given in the paper");
  add_file(sub, "--claims-table", command.claims_table, "Also write the claims as a Markdown table")
      ->needs(claims);
  add_allocation(sub, command.allocation);
}

}  // namespace

Result<Outcome> execute(const ValidateCommand& command) {
  AWMR_ASSIGN_OR_RETURN(Model model, read_model(command.model));
  choose(command.allocation, model, {});
  AWMR_ASSIGN_OR_RETURN(const std::optional<ModeGains> gains, gains_of(command, model));
  AWMR_RETURN_IF_ERROR(check_outputs(command));
  AWMR_ASSIGN_OR_RETURN(
      Validation validation,
      validate_with_progress(model, command.scenario ? std::nullopt : gains, command.validate));
  std::vector<Finding> findings;
  AWMR_RETURN_IF_ERROR(add_evaluated_logs(command, model, gains, validation, findings));
  AWMR_ASSIGN_OR_RETURN(const Provenance provenance, provenance_of(command));
  if (command.gains) {
    AWMR_RETURN_IF_ERROR(note_other_model(*command.gains, command.model, findings));
  }
  note_fitted_logs(model, provenance, findings);
  Outcome outcome{.summary = summary_of(command, validation, model.vehicle),
                  .details = command.claims ? "" : validation_table(validation),
                  .closing = fmt::format("wrote {}\n", command.output.string()),
                  .brief = brief_of(validation, model.vehicle),
                  .findings = std::move(findings),
                  .refused = !validation.passed,
                  .document = validation_text(validation, provenance),
                  .written = {command.output}};
  put_findings_into_document(outcome);
  AWMR_RETURN_IF_ERROR(write_file(command.output, outcome.document, check_json_text));
  if (command.claims_table) {
    const std::string table = claims_markdown(
        validation.claims, "awmr validate --model MODEL --claims --claims-table FILE");
    AWMR_RETURN_IF_ERROR(write_file(*command.claims_table, table));
    outcome.written.push_back(*command.claims_table);
  }
  return outcome;
}

void add_validate(CLI::App& app, Session& session) {
  auto command = std::make_shared<ValidateCommand>();
  auto columns = std::make_shared<ColumnWords>();
  auto excluded = std::make_shared<std::vector<std::string>>();
  CLI::App* sub = add_command(
      app, session, "validate", "Validate the model on its trials and the paper's claims",
      "awmr validate --model model.json --gains gains.json -o validation.json",
      [command, columns, excluded]() -> Result<Outcome> {
        AWMR_ASSIGN_OR_RETURN(command->trials.columns, column_mappings(*columns));
        if (command->acceptance.from_s && !command->scenario) {
          command->trials.used_s.lo = *command->acceptance.from_s;
        }
        AWMR_RETURN_IF_ERROR(use_parts(*excluded, command->trials));
        command->validate.open_cases = command->claims;
        return execute(*command);
      });
  add_model_options(*sub, *command);
  add_log_options(*sub, *command, *columns, *excluded);
  add_drive_options(*sub, *command);
  add_claims_options(*sub, *command);
  add_output(*sub, command->output, "validation.json to write");
}

}  // namespace awmr::cli
