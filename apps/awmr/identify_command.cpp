#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "awmr/core/file.h"
#include "awmr/trials/steady.h"
#include "commands.h"
#include "identify_options.h"

namespace awmr::cli {
namespace {

Result<Provenance> provenance_of(const IdentifyCommand& command) {
  Provenance provenance{"identify", described(command.identify), {}};
  provenance.options.emplace_back("prefer", name_in(kPreferenceNames, command.trials.preference));
  if (command.steady_from_logs) provenance.options.emplace_back("steady_from_logs", "true");
  for (const ColumnMapping& mapping : command.trials.columns) {
    provenance.options.emplace_back(
        "column", fmt::format("{}={}*{}+{}", mapping.name, mapping.source,
                              format_number(mapping.scale), format_number(mapping.offset)));
  }
  std::vector<fs::path> paths{command.vehicle};
  if (command.surge) paths.push_back(*command.surge);
  paths.insert(paths.end(), command.coastdowns.begin(), command.coastdowns.end());
  if (command.turning) paths.push_back(*command.turning);
  paths.insert(paths.end(), command.logs.begin(), command.logs.end());
  for (const fs::path& path : paths) {
    auto input = input_file(path);
    if (!input) return tl::unexpected(input.error());
    provenance.inputs.push_back(*input);
  }
  return provenance;
}

/// Reads all trials; the faults of all files come together.
class TrialFiles {
 public:
  TrialFiles(const IdentifyCommand& command, const Vehicle& vehicle)
      : command_(command), vehicle_(vehicle) {}

  Result<TrialData> read(std::vector<Finding>& findings) {
    const TrialOptions& options = command_.trials;
    if (command_.surge) keep(read_surge(*command_.surge, options, findings), data_.surge);
    if (command_.turning) {
      keep(read_turning(*command_.turning, vehicle_, options, findings), data_.turning);
    }
    for (const fs::path& path : command_.coastdowns) {
      std::optional<CoastdownSet> set;
      keep(read_coastdown(path, options, findings), set);
      if (set) add_coastdown(path, std::move(*set));
    }
    for (const fs::path& path : command_.logs) {
      std::optional<DrivingLog> log;
      keep(read_log(path, options, findings), log);
      if (log) data_.logs.push_back(std::move(*log));
    }
    if (!faults_.empty()) return input_errors(std::move(faults_));
    if (command_.steady_from_logs) add_steady_runs(findings);
    return std::move(data_);
  }

 private:
  template <class Read, class Kept>
  void keep(Result<Read> read, std::optional<Kept>& kept) {
    if (read) {
      kept = std::move(*read);
    } else {
      faults_.insert(faults_.end(), read.error().faults.begin(), read.error().faults.end());
    }
  }

  void add_coastdown(const fs::path& path, CoastdownSet set) {
    data_.curves.insert(data_.curves.end(), set.curves.begin(), set.curves.end());
    if (!set.curves.empty()) return;
    if (data_.coastdown) {
      faults_.push_back({path.string(), "a second file of stop times; put all rows into one"});
      return;
    }
    data_.coastdown = std::move(set);
  }

  /// Rows found in logs join those of a file; their findings name the log.
  void add_steady_runs(std::vector<Finding>& findings) {
    const auto join = [](auto& all, auto& found) {
      if (found.rows.empty()) return;
      if (!all) {
        all = std::move(found);
      } else {
        all->rows.insert(all->rows.end(), found.rows.begin(), found.rows.end());
      }
    };
    for (const DrivingLog& log : data_.logs) {
      SteadyRuns runs = steady_runs(log, vehicle_, {}, findings);
      join(data_.surge, runs.surge);
      join(data_.turning, runs.turning);
    }
  }

  const IdentifyCommand& command_;
  const Vehicle& vehicle_;
  TrialData data_;
  std::vector<Fault> faults_;
};

std::string names_of(const EstimatorReport& report) {
  const std::string name(name_in(kEstimatorNames, report.estimator));
  return report.family.empty() ? name : name + " " + report.family;
}

std::string summary_of(const IdentifyCommand& command, const Model& model) {
  std::string text =
      fmt::format("{}: {} trial rows\n", model.vehicle.name, model.record.trials.size());
  text += parameter_table_text(model);
  text += "  estimators side by side:\n";
  for (const EstimatorReport& report : model.record.reports) {
    std::string values;
    for (const EstimatorParameter& parameter : report.parameters) {
      values += fmt::format(" {}={:.4f}", parameter.name, parameter.value);
    }
    const std::string score = report.aicc ? fmt::format(" AICc {:.1f}", *report.aicc) : "";
    text += fmt::format("    {:<6} {:<36} noise on {:<10}{}{}\n",
                        name_in(kFitSubjectNames, report.subject), names_of(report), report.noise,
                        values, score);
  }
  return text + fmt::format("wrote {}\n", command.output.string());
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
  const auto vehicle = read_vehicle(command.vehicle);
  if (!vehicle) return tl::unexpected(vehicle.error());
  std::vector<Finding> findings;
  const auto data = TrialFiles(command, *vehicle).read(findings);
  if (!data) return tl::unexpected(data.error());

  auto provenance = provenance_of(command);
  if (!provenance) return tl::unexpected(provenance.error());
  auto identified = identify(*vehicle, *data, command.identify, std::move(findings));
  if (!identified) return tl::unexpected(identified.error());
  identified->model.record.provenance = std::move(*provenance);
  if (const auto written = write_file(command.output, model_text(identified->model)); !written) {
    return tl::unexpected(written.error());
  }
  const Model& model = identified->model;
  return Outcome{.summary = summary_of(command, model),
                 .brief = parameter_table_text(model),
                 .findings = model.record.findings,
                 .refused = !identified->refused.empty()};
}

void add_identify(CLI::App& app, Session& session) {
  struct Raw {
    IdentifyCommand command;
    std::vector<std::string> columns, asked, families;
    std::string method, noise, loss = "squares", prefer = "printed";
  };
  auto raw = std::make_shared<Raw>();
  CLI::App* sub = add_command(
      app, session, "identify", "Fit the vehicle's parameters to its trials and logs",
      "awmr identify --vehicle vehicle.json --surge surge.csv --turning turning.csv -o model.json",
      [raw]() -> Result<Outcome> {
        IdentifyCommand& command = raw->command;
        for (const std::string& text : raw->columns) {
          auto mapping = parse_column_mapping(text);
          if (!mapping) return tl::unexpected(mapping.error());
          command.trials.columns.push_back(*mapping);
        }
        for (const std::string& name : raw->asked) {
          if (auto added = add_asked(name, command.identify); !added) {
            return tl::unexpected(added.error());
          }
        }
        for (const std::string& text : raw->families) {
          if (auto added = add_family(text, command.identify); !added) {
            return tl::unexpected(added.error());
          }
        }
        if (!raw->method.empty()) command.identify.method = value_in(kMethodNames, raw->method);
        if (!raw->noise.empty()) command.identify.noise = value_in(kErrorModelNames, raw->noise);
        command.identify.loss = *value_in(kLossNames, raw->loss);
        command.trials.preference = *value_in(kPreferenceNames, raw->prefer);
        return execute(command);
      });
  IdentifyCommand& command = raw->command;
  sub->add_option("--vehicle", command.vehicle, "vehicle.json: what is known beforehand")
      ->required();
  sub->add_option("--surge", command.surge, "CSV of runs at constant thrust, wheels straight");
  sub->add_option("--coastdown", command.coastdowns,
                  "CSV of coast-downs, motors off: stop times or whole curves; may be repeated");
  sub->add_option("--turning", command.turning, "CSV of runs at constant thrust and steering");
  sub->add_option("--log", command.logs, "CSV of a driving log; may be repeated");
  sub->add_option("--method", raw->method,
                  "Which estimator fills the main values: log-linear (default for tables), "
                  "nonlinear, trajectory (default with --log)")
      ->check(CLI::IsMember(names_in(kMethodNames)));
  sub->add_option("--noise", raw->noise,
                  "Where the nonlinear fit puts the error: force, speed or time (default: on what "
                  "was measured)")
      ->check(CLI::IsMember(names_in(kErrorModelNames)));
  sub->add_option("--family", raw->families,
                  "Resistance: power (default), coulomb-linear, coulomb-linear-quadratic, "
                  "coulomb-power, dead-zone, or auto (least AICc); surge=NAME, yaw=NAME for one")
      ->delimiter(',');
  sub->add_option("--loss", raw->loss, "squares (default), huber, cauchy or tukey")
      ->check(CLI::IsMember(names_in(kLossNames)));
  sub->add_flag("--joint", command.identify.joint,
                "Fit a1, b1 and m' together from the surge runs and the coast-down curves");
  sub->add_option("--fit", raw->asked,
                  "What is asked for, e.g. surge.alpha,mass_norm; for logs also all, "
                  "input_delay_s, bias.yaw_rate_radps, ...")
      ->delimiter(',');
  sub->add_flag("--steady-from-log", command.steady_from_logs,
                "Take steady stretches of the logs as surge and turning runs");
  sub->add_option("--starts", command.identify.starts,
                  "Random starts of a fit of logs without tables (default 6)")
      ->check(CLI::Range(0, 1000));
  sub->add_option("--bootstrap", command.identify.bootstrap,
                  "Intervals of a fit of logs from this many block bootstrap resamples")
      ->check(CLI::Range(0, 1000000));
  sub->add_flag("--cross-validate", command.identify.cross_validate,
                "Leave each log out once and predict it from the others");
  sub->add_option("--seed", command.identify.seed, "Of starts and bootstrap (default 1)");
  sub->add_option("--threads", command.identify.threads,
                  "Default: all; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
  sub->add_option("--prefer", raw->prefer,
                  "Which of two disagreeing values to use: printed (default) or timed")
      ->check(CLI::IsMember(names_in(kPreferenceNames)));
  sub->add_option("--column", raw->columns, "NAME=SOURCE[*SCALE][+OFFSET]: another column's name");
  add_output(*sub, command.output, "model.json to write");
}

}  // namespace awmr::cli
