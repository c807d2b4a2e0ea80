#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "awmr/core/file.h"
#include "awmr/model/model_file.h"
#include "awmr/model/vehicle_file.h"
#include "awmr/trials/load.h"
#include "choices.h"
#include "commands.h"
#include "identify_options.h"
#include "inputs.h"
#include "numbers.h"
#include "paths.h"
#include "progress.h"

namespace awmr::cli {
namespace {

std::vector<fs::path> inputs_of(const IdentifyCommand& command) {
  std::vector<fs::path> paths{command.vehicle};
  if (command.surge) paths.push_back(*command.surge);
  paths.insert(paths.end(), command.coastdowns.begin(), command.coastdowns.end());
  if (command.turning) paths.push_back(*command.turning);
  paths.insert(paths.end(), command.logs.begin(), command.logs.end());
  return paths;
}

Result<Provenance> provenance_of(const IdentifyCommand& command) {
  Provenance provenance{"identify", described(command.identify), {}};
  provenance.options.emplace_back("prefer", name_in(kPreferenceNames, command.trials.preference));
  if (command.trials.as_is) provenance.options.emplace_back("as-is", "true");
  if (command.steady_from_logs) provenance.options.emplace_back("steady_from_logs", "true");
  for (const ColumnMapping& mapping : command.trials.columns) {
    provenance.options.emplace_back("column", text_of(mapping));
  }
  AWMR_ASSIGN_OR_RETURN(provenance.inputs, input_files(inputs_of(command), command.names));
  return provenance;
}

Result<Identification> identify_with_progress(const Trials& trials, IdentifyOptions options) {
  Working working("fitting the tables");
  options.doing = [&](std::string_view what) { working.doing(what); };
  return identify(trials, options);
}

std::string names_of(const EstimatorReport& report) {
  const std::string name(name_in(kEstimatorNames, report.estimator));
  return report.family.empty() ? name : name + " " + report.family;
}

std::string summary_of(const Model& model) {
  return fmt::format("{}: {} trial rows\n", model.vehicle.name, model.record.trials.size()) +
         parameter_table_text(model) + si_table_text(model);
}

std::string estimators_of(const Model& model) {
  std::string text = "estimators side by side\n";
  for (const EstimatorReport& report : model.record.reports) {
    std::string values;
    for (const EstimatorParameter& parameter : report.parameters) {
      values += fmt::format(" {}={:.4f}", parameter.name, parameter.value);
    }
    const std::string score = report.aicc ? fmt::format(" AICc {:.1f}", *report.aicc) : "";
    text += fmt::format("  {:<6} {:<36} noise on {:<10}{}{}\n",
                        name_in(kFitSubjectNames, report.subject), names_of(report), report.noise,
                        values, score);
  }
  return text;
}

/// The command and what the command line says of it in words.
struct IdentifyWords {
  IdentifyCommand command;
  ColumnWords columns;
  std::vector<std::string> asked;
  std::vector<std::string> families;
  std::string method;
  std::string noise;
  std::string loss = "squares";
  std::string prefer = "printed";
};

/// Errors: a malformed column mapping; an unknown parameter or family.
Result<IdentifyCommand> command_of(const IdentifyWords& words) {
  IdentifyCommand command = words.command;
  AWMR_ASSIGN_OR_RETURN(command.trials.columns, column_mappings(words.columns));
  for (const std::string& name : words.asked) {
    AWMR_RETURN_IF_ERROR(add_asked(name, command.identify));
  }
  for (const std::string& name : words.families) {
    AWMR_RETURN_IF_ERROR(add_family(name, command.identify));
  }
  if (!words.method.empty()) command.identify.method = value_in(kMethodNames, words.method);
  if (!words.noise.empty()) command.identify.noise = value_in(kErrorModelNames, words.noise);
  command.identify.loss = *value_in(kLossNames, words.loss);
  command.trials.preference = *value_in(kPreferenceNames, words.prefer);
  return command;
}

void add_trial_files(CLI::App& sub, IdentifyCommand& command) {
  add_file(sub, "--vehicle", command.vehicle, "vehicle.json: what is known beforehand")->required();
  add_file(sub, "--surge", command.surge, "CSV of runs at constant thrust, wheels straight");
  add_file(sub, "--coastdown", command.coastdowns,
           "CSV of coast-downs, motors off: stop times or whole curves; may be repeated");
  add_file(sub, "--turning", command.turning, "CSV of runs at constant thrust and steering");
  add_file(sub, "--log", command.logs, "CSV of a driving log; may be repeated");
}

void add_fit_options(CLI::App& sub, IdentifyWords& words) {
  sub.add_option("--method", words.method,
                 "Which estimator fills the main values: log-linear (default for tables), "
                 "nonlinear, trajectory (default with --log)")
      ->check(one_of(names_in(kMethodNames)));
  sub.add_option("--noise", words.noise,
                 "Where the nonlinear fit puts the error: force, speed or time (default: on what "
                 "was measured)")
      ->check(one_of(names_in(kErrorModelNames)));
  sub.add_option(
         "--family", words.families,
         "Resistance: power (default; logs take another where it is plainly better), "
         "coulomb-linear, coulomb-linear-quadratic, coulomb-power, dead-zone, or auto (least "
         "AICc); surge=NAME, yaw=NAME for one")
      ->delimiter(',');
  sub.add_option("--loss", words.loss, "squares (default), huber, cauchy or tukey")
      ->check(one_of(names_in(kLossNames)));
  sub.add_flag("--joint", words.command.identify.joint,
               "Fit a1, b1 and m' together from the surge runs and the coast-down curves");
  sub.add_option("--fit", words.asked,
                 "What is asked for, e.g. surge.alpha,mass_norm; for logs also all, "
                 "input_delay_s, bias.yaw_rate_radps, ...")
      ->delimiter(',');
}

void add_log_options(CLI::App& sub, IdentifyCommand& command) {
  sub.add_flag("--steady-from-log", command.steady_from_logs,
               "Take steady stretches of the logs as surge and turning runs");
  sub.add_option("--starts", command.identify.starts,
                 "Random starts of a fit of logs without tables (default 6)")
      ->check(within(0, 1000));
  sub.add_option("--bootstrap", command.identify.bootstrap,
                 "Shape of the intervals of a fit of logs from this many block bootstrap resamples")
      ->check(within(0, 1000000));
  sub.add_option("--time-limit", command.identify.time_limit_s,
                 "Seconds after which the searches in logs stop; what has not converged by then is "
                 "refused (default: none)")
      ->check(within(0.1, 1e6));
  sub.add_flag("--cross-validate", command.identify.cross_validate,
               "Leave each log out once and predict it from the others");
  sub.add_option("--seed", command.identify.seed, "Of starts and bootstrap (default 1)")
      ->check(within<std::uint64_t>(0, kAnySeed));
  sub.add_option("--threads", command.identify.threads,
                 "Default: all; the result does not depend on it")
      ->check(within(1, 1024));
}

void add_reading_options(CLI::App& sub, IdentifyWords& words) {
  sub.add_flag("--as-is", words.command.trials.as_is,
               "Take logs whose units, signs or sides contradict themselves as they are");
  sub.add_option("--prefer", words.prefer,
                 "Which of two disagreeing values to use: printed (default) or timed")
      ->check(one_of(names_in(kPreferenceNames)));
  sub.add_option("--column", words.columns.columns, kColumnHelp);
  add_file(sub, "--columns-file", words.columns.file, kColumnsFileHelp);
}

}  // namespace

Result<Outcome> execute(const IdentifyCommand& command) {
  if (!command.surge && command.coastdowns.empty() && !command.turning && command.logs.empty()) {
    return input_error("",
                       "no trials: give at least one of --surge, --coastdown, --turning, --log");
  }
  if (command.steady_from_logs && command.logs.empty()) {
    return input_error("--steady-from-log", "needs a log (--log)");
  }
  AWMR_RETURN_IF_ERROR(check_output(command.output, inputs_of(command)));
  AWMR_ASSIGN_OR_RETURN(Vehicle vehicle, read_vehicle(command.vehicle));
  AWMR_ASSIGN_OR_RETURN(const Trials trials,
                        load_trials({.vehicle = std::move(vehicle),
                                     .surge = command.surge,
                                     .turning = command.turning,
                                     .coastdowns = command.coastdowns,
                                     .logs = command.logs,
                                     .steady_from_logs = command.steady_from_logs,
                                     .options = command.trials}));
  AWMR_ASSIGN_OR_RETURN(Provenance provenance, provenance_of(command));
  AWMR_ASSIGN_OR_RETURN(Identification identified,
                        identify_with_progress(trials, command.identify));
  Model& model = identified.model;
  model.record.provenance = std::move(provenance);
  std::string document = model_text(model);
  AWMR_RETURN_IF_ERROR(write_file(command.output, document));
  return Outcome{.summary = summary_of(model),
                 .details = estimators_of(model),
                 .closing = fmt::format("wrote {}\n", command.output.string()),
                 .brief = parameter_table_text(model),
                 .findings = model.record.findings,
                 .refused = !identified.refused.empty(),
                 .document = std::move(document),
                 .written = {command.output}};
}

void add_identify(CLI::App& app, Session& session) {
  auto words = std::make_shared<IdentifyWords>();
  CLI::App* sub = add_command(
      app, session, "identify", "Fit the vehicle's parameters to its trials and logs",
      "awmr identify --vehicle configs/paper/vehicle.json --surge datasets/paper/surge.csv "
      "--coastdown datasets/paper/coastdown.csv --turning datasets/paper/turning.csv "
      "-o model.json\n"
      "  awmr identify --vehicle configs/paper/vehicle.json --log datasets/synthetic/drive_1.csv "
      "-o driven.json",
      [words]() -> Result<Outcome> {
        AWMR_ASSIGN_OR_RETURN(const IdentifyCommand command, command_of(*words));
        return execute(command);
      });
  add_trial_files(*sub, words->command);
  add_fit_options(*sub, *words);
  add_log_options(*sub, words->command);
  add_reading_options(*sub, *words);
  add_output(*sub, words->command.output, "model.json to write");
}

}  // namespace awmr::cli
