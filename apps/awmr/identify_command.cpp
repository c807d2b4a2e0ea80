#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <utility>

#include "awmr/core/file.h"
#include "awmr/core/nearest.h"
#include "commands.h"

namespace awmr::cli {
namespace {

const std::map<std::string, Method> kMethods{{"log-linear", Method::kLogLinear},
                                             {"nonlinear", Method::kNonlinear}};
const std::map<std::string, Noise> kNoises{
    {"force", Noise::kForce}, {"speed", Noise::kSpeed}, {"time", Noise::kTime}};
const std::map<std::string, Preference> kPreferences{{"printed", Preference::kPrinted},
                                                     {"timed", Preference::kTimed}};

template <class T>
std::string key_of(const std::map<std::string, T>& names, T value) {
  for (const auto& [name, candidate] : names) {
    if (candidate == value) return name;
  }
  return {};
}

Result<Provenance> provenance_of(const IdentifyCommand& command) {
  Provenance provenance{"identify", {}, {}};
  provenance.options = {{"method", key_of(kMethods, command.identify.method)},
                        {"noise", command.identify.noise ? key_of(kNoises, *command.identify.noise)
                                                         : std::string("as measured")},
                        {"prefer", key_of(kPreferences, command.trials.preference)}};
  for (const ParameterId id : command.identify.asked) {
    provenance.options.emplace_back("fit", info(id).name);
  }
  for (const ColumnMapping& mapping : command.trials.columns) {
    provenance.options.emplace_back(
        "column", fmt::format("{}={}*{}+{}", mapping.name, mapping.source,
                              format_number(mapping.scale), format_number(mapping.offset)));
  }
  for (const auto& path :
       {std::optional(command.vehicle), command.surge, command.coastdown, command.turning}) {
    if (!path) continue;
    auto input = input_file(*path);
    if (!input) return tl::unexpected(input.error());
    provenance.inputs.push_back(*input);
  }
  return provenance;
}

/// Reads one kind of trial where its file is given; faults are collected, so that all files are
/// read.
template <class Set, class Read>
void read_trial(const std::optional<fs::path>& path, std::optional<Set>& set, Read read,
                std::vector<Fault>& faults) {
  if (!path) return;
  auto rows = read(*path);
  if (rows) {
    set = std::move(*rows);
  } else {
    faults.insert(faults.end(), rows.error().faults.begin(), rows.error().faults.end());
  }
}

std::string summary_of(const IdentifyCommand& command, const Model& model) {
  std::string text = fmt::format("{}: {} trial rows\n", model.vehicle.name, model.trials.size());
  text += parameter_table_text(model);
  text += "  estimators side by side (alpha, beta):\n";
  for (const EstimatorReport& report : model.reports) {
    if (report.parameters.size() != 2) continue;
    text += fmt::format("    {:<6} {:<11} noise on {:<10} {:.4f} {:.4f}\n", report.subject,
                        report.estimator, report.noise, report.parameters[0].value,
                        report.parameters[1].value);
  }
  return text + fmt::format("wrote {}\n", command.output.string());
}

}  // namespace

Result<Outcome> execute(const IdentifyCommand& command) {
  if (!command.surge && !command.coastdown && !command.turning) {
    return input_error("", "no trials: give at least one of --surge, --coastdown, --turning");
  }
  const auto vehicle = read_vehicle(command.vehicle);
  if (!vehicle) return tl::unexpected(vehicle.error());

  std::vector<Finding> findings;
  std::vector<Fault> faults;
  TrialData data;
  read_trial(
      command.surge, data.surge,
      [&](const fs::path& p) { return read_surge(p, command.trials, findings); }, faults);
  read_trial(
      command.coastdown, data.coastdown,
      [&](const fs::path& p) { return read_coastdown(p, command.trials, findings); }, faults);
  read_trial(
      command.turning, data.turning,
      [&](const fs::path& p) { return read_turning(p, *vehicle, command.trials, findings); },
      faults);
  if (!faults.empty()) return input_errors(std::move(faults));

  auto provenance = provenance_of(command);
  if (!provenance) return tl::unexpected(provenance.error());
  auto identified = identify(*vehicle, data, command.identify, std::move(findings));
  if (!identified) return tl::unexpected(identified.error());
  identified->model.provenance = std::move(*provenance);
  if (const auto written = write_file(command.output, model_text(identified->model)); !written) {
    return tl::unexpected(written.error());
  }
  const Model& model = identified->model;
  return Outcome{.summary = summary_of(command, model),
                 .brief = parameter_table_text(model),
                 .findings = model.findings,
                 .refused = !identified->refused.empty()};
}

void add_identify(CLI::App& app, Session& session) {
  struct Raw {
    IdentifyCommand command;
    std::vector<std::string> columns;
    std::vector<std::string> asked;
    std::string noise;
  };
  auto raw = std::make_shared<Raw>();
  CLI::App* sub = add_command(
      app, session, "identify", "Fit the vehicle's parameters to its trials",
      "awmr identify --vehicle vehicle.json --surge surge.csv --turning turning.csv -o model.json",
      [raw]() -> Result<Outcome> {
        for (const std::string& text : raw->columns) {
          auto mapping = parse_column_mapping(text);
          if (!mapping) return tl::unexpected(mapping.error());
          raw->command.trials.columns.push_back(*mapping);
        }
        for (const std::string& name : raw->asked) {
          const auto id = parameter_by_name(name);
          if (!id) {
            std::vector<std::string> names;
            for (const ParameterInfo& p : parameter_table()) names.emplace_back(p.name);
            return input_error("--fit", fmt::format("no parameter is called '{}'; the names are {}",
                                                    name, fmt::join(names, ", ")));
          }
          raw->command.identify.asked.push_back(*id);
        }
        if (!raw->noise.empty()) raw->command.identify.noise = kNoises.at(raw->noise);
        return execute(raw->command);
      });
  IdentifyCommand& command = raw->command;
  sub->add_option("--vehicle", command.vehicle, "vehicle.json: what is known beforehand")
      ->required();
  sub->add_option("--surge", command.surge, "CSV of runs at constant thrust, wheels straight");
  sub->add_option("--coastdown", command.coastdown, "CSV of coast-downs, motors off");
  sub->add_option("--turning", command.turning, "CSV of runs at constant thrust and steering");
  sub->add_option("--method", command.identify.method, "log-linear (default) or nonlinear")
      ->transform(CLI::CheckedTransformer(kMethods));
  sub->add_option("--noise", raw->noise,
                  "Where the nonlinear fit puts the error: force, speed or time (default: on what "
                  "was measured)")
      ->check(CLI::IsMember({"force", "speed", "time"}));
  sub->add_option("--fit", raw->asked, "Parameters asked for, e.g. surge.alpha,mass_norm")
      ->delimiter(',');
  sub->add_option("--prefer", command.trials.preference,
                  "Which of two disagreeing values to use: printed (default) or timed")
      ->transform(CLI::CheckedTransformer(kPreferences));
  sub->add_option("--column", raw->columns, "NAME=SOURCE[*SCALE][+OFFSET]: another column's name");
  add_output(*sub, command.output, "model.json to write");
}

}  // namespace awmr::cli
