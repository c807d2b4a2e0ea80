#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "awmr/core/file.h"
#include "awmr/core/option_text.h"
#include "awmr/model/model_file.h"
#include "awmr/model/plausibility.h"
#include "awmr/model/vehicle_file.h"
#include "commands.h"
#include "identify_options.h"
#include "identify_words.h"
#include "inputs.h"
#include "option_values.h"
#include "progress.h"

namespace awmr::cli {
namespace {

std::vector<fs::path> inputs_of(const IdentifyCommand& command) {
  return all_paths(command.vehicle, paths_of(command.trials));
}

Result<Provenance> provenance_of(const IdentifyCommand& command) {
  Provenance provenance{"identify", described(command.identify), {}};
  describe_reading(command.trials, provenance.options);
  AWMR_ASSIGN_OR_RETURN(provenance.inputs, input_files(inputs_of(command), command.names));
  return provenance;
}

/// Approximate longest duration of the search, s, for the progress display only: the search is
/// limited by its effort, not by time.
double about_longest_s(const Trials& trials, const IdentifyOptions& options) {
  if (options.time_limit_s > 0.0 || trials.data.logs.empty()) return options.time_limit_s;
  double longest_s = 40.0;
  for (const DrivingLog& log : trials.data.logs) {
    longest_s += 0.05 * (log.t_s.back() - log.t_s.front());
  }
  return longest_s;
}

Result<Identification> identify_with_progress(const Trials& trials, IdentifyOptions options) {
  Working working("fitting the tables", about_longest_s(trials, options));
  options.doing = [&](std::string_view what) { working.doing(what); };
  options.notice = print_notice;
  return identify(trials, options);
}

std::string names_of(const EstimatorReport& report) {
  const std::string name(name_in(kEstimatorNames, report.estimator));
  return report.family.empty() ? name : name + " " + report.family;
}

/// Describes the tyre scrub, which is the yaw moment that differential turns need in addition to
/// the yaw resistance. Empty if the trials do not determine it.
std::string scrub_text(const Model& model) {
  if (!model.yaw_scrub) return {};
  const YawScrub& scrub = *model.yaw_scrub;
  return fmt::format(
      "tyre scrub: {} differential turns needed {:.3g} m (95 %: {:.3g} to {:.3g}) of yaw moment "
      "in addition to the yaw resistance;\nawmr compare --break-even shows its effect on the "
      "choice of mode\n",
      scrub.rows, scrub.moment_m, scrub.ci95_m.lo, scrub.ci95_m.hi);
}

std::string summary_of(const Model& model) {
  return fmt::format("{}: {} trial rows\n", model.vehicle.name, model.record.trials.size()) +
         parameter_table_text(model) + si_table_text(model) + scrub_text(model);
}

std::string estimators_of(const Model& model) {
  std::string text = "estimators side by side\n";
  for (const EstimatorReport& report : model.record.reports) {
    std::string values = report.parameters.empty() ? " " + report.stop_reason : "";
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

}  // namespace

Result<Outcome> execute(const IdentifyCommand& command) {
  if (paths_of(command.trials).empty()) {
    return input_error(ErrorCode::kMissing, "",
                       "no trials: give at least one of --surge, --coastdown, --turning, --log");
  }
  if (command.trials.steady_from_logs && command.trials.logs.empty()) {
    return input_error(ErrorCode::kMissing, "--steady-from-log", "needs a log: give --log FILE");
  }
  AWMR_RETURN_IF_ERROR(check_output(command.output, inputs_of(command)));
  AWMR_ASSIGN_OR_RETURN(Vehicle vehicle, read_vehicle(command.vehicle));
  if (!command.trials.options.as_is) {
    AWMR_RETURN_IF_ERROR(check_plausible(vehicle, command.vehicle.string() + ":",
                                         "Correct it, or give " + option_text("as-is")));
  }
  AWMR_ASSIGN_OR_RETURN(const Trials trials, load_trials(std::move(vehicle), command.trials));
  AWMR_ASSIGN_OR_RETURN(Provenance provenance, provenance_of(command));
  AWMR_ASSIGN_OR_RETURN(Identification identified,
                        identify_with_progress(trials, command.identify));
  Model& model = identified.model;
  model.record.provenance = std::move(provenance);
  std::string document = model_text(model);
  AWMR_RETURN_IF_ERROR(write_file(command.output, document, check_model_text));
  return Outcome{.summary = summary_of(model),
                 .details = estimators_of(model),
                 .closing = fmt::format("wrote {}\n", command.output.string()),
                 .brief = parameter_table_text(model),
                 .findings = model.record.findings,
                 .refused = !identified.refused.empty() || identified.has_refused_terms,
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
  add_table_files(*sub, words->command);
  add_file(*sub, "--log", words->command.trials.logs,
           "Driving log: CSV, or another format that awmr map reads; may be repeated");
  add_fit_options(*sub, *words);
  add_log_options(*sub, words->command);
  TrialOptions& reading = words->command.trials.options;
  sub->add_option("--from", reading.used_s.lo, "Use each log from this time on, s, as in its t_s")
      ->check(within(-kMaxTime_s, kMaxTime_s));
  add_end_options(*sub, reading, words->excluded);
  add_reading_options(*sub, *words);
  add_output(*sub, words->command.output, "model.json to write");
}

}  // namespace awmr::cli
