#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>

#include "awmr/core/containers.h"
#include "awmr/core/file.h"
#include "awmr/core/option_text.h"
#include "awmr/model/model_file.h"
#include "awmr/model/plausibility.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/tune/tune_file.h"
#include "commands.h"
#include "json_output.h"
#include "option_values.h"
#include "project.h"
#include "project_options.h"
#include "run_files.h"

namespace awmr::cli {
namespace {

struct RunCommand {
  fs::path project;
  fs::path output;
  bool figures = false;
};

/// Results of the steps of `run`: their combined outcome, and the JSON document of each step. The
/// documents are stored under the names of their files ("model").
struct Steps {
  Outcome total;
  std::vector<std::pair<std::string, std::string>> documents;
};

void add_written(Outcome& total, const std::vector<fs::path>& written) {
  append(total.written, written);
}

/// Adds the outcome of a step to the combined one. Of the step's text, the summary gets only the
/// short one (Outcome::brief), below the line `title`.
void add_step(Steps& steps, const char* title, Outcome step) {
  Outcome& total = steps.total;
  steps.documents.emplace_back(step.written.front().stem().string(), std::move(step.document));
  add_written(total, step.written);
  total.summary += fmt::format("{}\n{}", title, step.brief);
  for (Finding& finding : step.findings) {
    const bool is_known = std::ranges::any_of(total.findings, [&](const Finding& other) {
      return other.code == finding.code && other.message == finding.message;
    });
    if (!is_known) total.findings.push_back(std::move(finding));
  }
  total.refused = total.refused || step.refused;
}

Result<Outcome> identify_step(const Project& project, const InputNames& names,
                              const fs::path& model) {
  return for_project("identify", execute(IdentifyCommand{.vehicle = project.vehicle,
                                                         .trials = project.trials,
                                                         .identify = project.identify,
                                                         .output = model,
                                                         .names = names}));
}

Result<Outcome> validate_step(const Project& project, const InputNames& names,
                              const fs::path& directory) {
  return for_project("validate", execute(ValidateCommand{.model = directory / "model.json",
                                                         .gains = directory / "gains.json",
                                                         .validate = {},
                                                         .output = directory / "validation.json",
                                                         .logs = project.trials.logs,
                                                         .trials = project.trials.options,
                                                         .other_columns = true,
                                                         .names = names}));
}

/// Returns the paths of all files that the project names, and of the project file itself.
std::vector<fs::path> inputs_of(const RunCommand& command, const Project& project,
                                const TuneConfig& tune) {
  return all_paths(command.project, project.vehicle, project.tune, paths_of(project.trials),
                   project.scenarios, tune.scenario_files);
}

template <class T>
void add_faults(const Result<T>& read, std::vector<Fault>& faults) {
  if (read) return;
  append(faults, read.error().faults);
}

Result<Trials> read_trials(const Project& project) {
  AWMR_ASSIGN_OR_RETURN(Vehicle vehicle, read_vehicle(project.vehicle));
  return load_trials(std::move(vehicle), project.trials);
}

/// Checks inputs and outputs before anything is written, and returns the paths of all input files.
/// Errors: an invalid file; an implausible vehicle; two scenario files of the same name. Also an
/// output file that is also an input, or that exists and was not written by awmr.
Result<std::vector<fs::path>> checked_inputs(const RunCommand& command, const Project& project) {
  TuneConfig tune;
  std::vector<Fault> faults;
  const auto trials = read_trials(project);
  add_faults(trials, faults);
  if (trials && !project.trials.options.as_is) {
    add_faults(check_plausible(trials->vehicle, project.vehicle.string() + ":",
                               "Correct it, or give \"as_is\": true under identify in " +
                                   command.project.filename().string()),
               faults);
  }
  if (project.tune) {
    auto read = read_tune_config(*project.tune);
    add_faults(read, faults);
    if (read) tune = *std::move(read);
  }
  std::set<std::string> stems;
  for (const fs::path& path : project.scenarios) {
    add_faults(read_scenario(path), faults);
    if (stems.insert(path.stem().string()).second) continue;
    faults.push_back({ErrorCode::kGivenTwice, command.project.string() + ":/compare/scenarios",
                      fmt::format("two scenarios are called {}, which would also be the name of "
                                  "their runs; rename one",
                                  path.stem().string())});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  std::vector<fs::path> inputs = inputs_of(command, project, tune);
  AWMR_RETURN_IF_ERROR(cli::check_outputs(command.output, run_outputs(project), inputs));
  AWMR_RETURN_IF_ERROR(check_own_results(command.output));
  return inputs;
}

constexpr const char* kFigures = "figures";

/// Writes the report page and, if requested, the figures.
Status report_step(const RunCommand& command, Outcome& total) {
  ReportCommand report{.directory = command.output};
  if (command.figures) report.figures = command.output / kFigures;
  AWMR_ASSIGN_OR_RETURN(const Outcome reported, execute(report));
  add_written(total, reported.written);
  append(total.findings, reported.findings);
  return {};
}

/// Writes the Arduino library. If that fails, for example because the firmware does not support the
/// vehicle, adds the warning `no-library`. It is no error: the other results are valid.
void emit_library(const fs::path& model, const fs::path& gains, const fs::path& output, bool as_is,
                  Outcome& total) {
  const Result<Outcome> emitted = for_project(
      "emit",
      execute(EmitCommand{.model = model, .gains = gains, .output = output, .as_is = as_is}));
  if (emitted) {
    append(total.findings, emitted->findings);
    return add_written(total, emitted->written);
  }
  total.findings.push_back(
      {model.filename().string(), 0, Severity::kWarning, "no-library",
       "there is no Arduino library for this vehicle: " + emitted.error().faults.front().message});
}

/// True if the model lacks a parameter that `tune` needs. A parameter that `identify` refused is
/// not always lacking: it may have a given or an assumed value.
Result<bool> lacks_parameters(const Outcome& identified, const fs::path& model) {
  if (!identified.refused) return false;
  AWMR_ASSIGN_OR_RETURN(const Model fitted, read_model(model));
  return !fitted.plant();
}

/// Executes the steps that need an identified model: tune, validate, emit, compare, simulate and
/// report.
Status steps_after_identify(const RunCommand& command, const Project& project,
                            const InputNames& names, Steps& steps) {
  const fs::path model = command.output / "model.json";
  const fs::path gains = command.output / "gains.json";
  AWMR_ASSIGN_OR_RETURN(
      Outcome tuned,
      for_project("tune",
                  execute(TuneCommand{
                      .model = model, .config = project.tune, .output = gains, .names = names})));
  add_step(steps, "tune", std::move(tuned));
  AWMR_ASSIGN_OR_RETURN(Outcome validated, validate_step(project, names, command.output));
  add_step(steps, "validate", std::move(validated));
  AWMR_ASSIGN_OR_RETURN(
      const Outcome emitted,
      for_project("emit", execute(EmitCommand{.model = model,
                                              .gains = gains,
                                              .output = command.output,
                                              .header_only = true,
                                              .as_is = project.trials.options.as_is})));
  add_written(steps.total, emitted.written);
  emit_library(model, gains, command.output / kLibrary, project.trials.options.as_is, steps.total);
  AWMR_ASSIGN_OR_RETURN(Outcome compared,
                        for_project("compare", execute(CompareCommand{
                                                   .model = model,
                                                   .gains = {gains},
                                                   .scenarios = project.scenarios,
                                                   .compare = project.compare,
                                                   .output = command.output,
                                                   .heading_rate_limit = project.heading_rate_limit,
                                                   .names = names})));
  add_step(steps, "compare", std::move(compared));
  AWMR_ASSIGN_OR_RETURN(const std::vector<fs::path> runs,
                        write_runs(project, names, command.output));
  add_written(steps.total, runs);
  return report_step(command, steps.total);
}

Result<Outcome> execute(const RunCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const Project project, read_project(command.project));
  AWMR_RETURN_IF_ERROR(check_output_directory(command.output));
  const auto checked = checked_inputs(command, project);
  if (!checked) return for_project("identify", tl::unexpected(checked.error()));
  const std::vector<fs::path>& inputs = *checked;
  AWMR_RETURN_IF_ERROR(
      make_directory(command.figures ? command.output / kFigures : command.output));
  const fs::path model = command.output / "model.json";
  const InputNames names = names_in_project(inputs, command.project);

  Steps steps;
  Outcome& total = steps.total;
  AWMR_ASSIGN_OR_RETURN(Outcome identified, identify_step(project, names, model));
  add_step(steps, "identify", std::move(identified));
  AWMR_ASSIGN_OR_RETURN(const bool has_gaps, lacks_parameters(total, model));
  if (has_gaps) {
    total.summary +=
        "stopped: the next steps need parameters that could not be identified; the errors name "
        "the trials to record\n";
    total.document = joined(steps.documents);
    put_findings_into_document(total);
    return total;
  }
  AWMR_RETURN_IF_ERROR(steps_after_identify(command, project, names, steps));
  total.summary += fmt::format(
      "wrote model.json gains.json validation.json awmr_params.h comparison.json comparison.csv,\n"
      "the runs, the Arduino library ({}){} and report.html to {}\n",
      kLibrary, command.figures ? fmt::format(", the figures ({})", kFigures) : "",
      command.output.string());
  total.document = joined(steps.documents);
  put_findings_into_document(total);
  return total;
}

}  // namespace

void add_run(CLI::App& app, Session& session) {
  auto command = std::make_shared<RunCommand>();
  CLI::App* sub = add_command(app, session, "run", "Run all steps of a project file",
                              "awmr run configs/paper/project.json -o out",
                              [command] { return execute(*command); });
  add_file(*sub, "PROJECT", command->project, "project.json")->required();
  add_output_directory(*sub, command->output, "Directory for all results");
  sub->add_flag("--figures", command->figures,
                "Also write all figures to DIR/figures: one CSV per figure, and plot.py, "
                "which draws them as SVG and PDF by matplotlib");
}

}  // namespace awmr::cli
