#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <span>

#include "awmr/core/file.h"
#include "awmr/identify/planning/recover.h"
#include "awmr/model/model_file.h"
#include "choices.h"
#include "commands.h"
#include "identify_options.h"
#include "inputs.h"
#include "numbers.h"
#include "paths.h"
#include "progress.h"

namespace awmr::cli {
namespace {

constexpr NameTable<RecoverPlan, 3> kPlans{
    {{"tables", RecoverPlan::kTables}, {"curve", RecoverPlan::kCurve}, {"log", RecoverPlan::kLog}}};
constexpr NameTable<ErrorModel, 4> kErrors{{{"log-force", ErrorModel::kLogForce},
                                            {"force", ErrorModel::kForce},
                                            {"speed", ErrorModel::kSpeed},
                                            {"time", ErrorModel::kTime}}};

std::string table_of(const Recovery& recovery) {
  std::string text = fmt::format("{} runs, {} of them with something refused; noise {}\n",
                                 recovery.runs, recovery.failed, recovery.noise_text);
  text += fmt::format("  {:<24} {:>10} {:>11} {:>10} {:>10} {:>9} {:>6}\n", "", "truth", "bias",
                      "rmse", "std error", "coverage", "runs");
  for (const RecoveredParameter& p : recovery.parameters) {
    text += fmt::format("  {:<24} {:>10.5g} {:>+11.2g} {:>10.2g} {:>10.2g} {:>7.1f} % {:>6}\n",
                        info(p.id).name, p.truth, p.bias, p.rmse, p.mean_std_error,
                        100.0 * p.coverage95, p.runs);
  }
  return text;
}

std::string document_of(const RecoverOptions& options, const std::vector<InputFile>& inputs,
                        const Recovery& recovery) {
  Provenance provenance{"recover", described(options.identify), inputs};
  provenance.options.emplace_back("plan", name_in(kPlans, options.plan));
  provenance.options.emplace_back("runs", std::to_string(options.runs));
  provenance.options.emplace_back("recover_seed", std::to_string(options.seed));
  return recovery_text(recovery, provenance);
}

/// The command and what the command line says of it in words.
struct RecoverWords {
  RecoverCommand command;
  std::string plan = "tables";
  std::string method;
  std::string noise;
  std::string error;
  std::vector<std::string> asked;
};

/// Errors: an unknown parameter.
Result<RecoverCommand> command_of(const RecoverWords& words) {
  RecoverCommand command = words.command;
  RecoverOptions& options = command.recover;
  options.plan = *value_in(kPlans, words.plan);
  if (!words.method.empty()) options.identify.method = value_in(kMethodNames, words.method);
  if (!words.noise.empty()) options.identify.noise = value_in(kErrorModelNames, words.noise);
  if (!words.error.empty()) options.error = value_in(kErrors, words.error);
  for (const std::string& name : words.asked) {
    AWMR_RETURN_IF_ERROR(add_asked(name, options.identify));
  }
  return command;
}

void add_runs(CLI::App& sub, RecoverCommand& command) {
  add_file(sub, "--model", command.model, "model.json from identify")->required();
  sub.add_option("--runs", command.recover.runs, "Simulated data sets (default 200)")
      ->check(within(2, 1000000));
  sub.add_option("--seed", command.recover.seed, "Default 1")
      ->check(within<std::uint64_t>(0, kAnySeed));
  sub.add_option("--threads", command.recover.threads,
                 "Default: all; the result does not depend on it")
      ->check(within(1, 1024));
}

void add_estimator(CLI::App& sub, RecoverWords& words) {
  sub.add_option("--plan", words.plan,
                 "tables (default): the model's own trials; curve: with a coast-down curve; log: a "
                 "driving log alone")
      ->check(one_of(names_in(kPlans)));
  sub.add_option("--method", words.method, "Estimator under test, as in identify")
      ->check(one_of(names_in(kMethodNames)));
  sub.add_option("--noise", words.noise, "Its noise model, as in identify")
      ->check(one_of(names_in(kErrorModelNames)));
  sub.add_option("--error", words.error,
                 "Where the simulated error of table rows lies: log-force, force, speed or time "
                 "(default: where the estimator assumes it)")
      ->check(one_of(names_in(kErrors)));
  sub.add_option("--fit", words.asked, "Parameters asked for, as in identify")->delimiter(',');
  sub.add_flag("--joint", words.command.recover.identify.joint, "As in identify");
}

void add_simulated_trials(CLI::App& sub, RecoverOptions& options) {
  sub.add_option("--speed-noise", options.sensors.speed_mps, "m/s (default 0.02)")
      ->check(within(0.0, 100.0));
  sub.add_option("--correlation", options.sensors.correlation_s,
                 "Correlation time of every sensor's error, s (default 0: white)")
      ->check(within(0.0, 1e4));
  sub.add_option("--duration", options.drive.duration_s, "Of a log, s (default 60)")
      ->check(within(1.0, 3600.0));
  sub.add_option("--rate", options.drive.rate_hz, "Of a log, Hz (default 100)")
      ->check(within(1.0, 1000.0));
}

}  // namespace

Result<Outcome> execute(const RecoverCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const Model model, read_model(command.model));
  AWMR_ASSIGN_OR_RETURN(const std::vector<InputFile> inputs, input_files({command.model}));
  if (command.output) {
    AWMR_RETURN_IF_ERROR(check_output(*command.output, std::span(&command.model, 1)));
  }
  RecoverOptions options = command.recover;
  options.identify.surge_family.family = model.surge_family;
  options.identify.yaw_family.family = model.yaw_family;
  auto bar = std::make_unique<Working>("simulating and fitting");
  auto recovered = recover(model, options, [&](int done) {
    (*bar)(static_cast<std::size_t>(done), static_cast<std::size_t>(options.runs));
  });
  bar.reset();  // cleared before anything is said
  AWMR_ASSIGN_OR_RETURN(const Recovery recovery, std::move(recovered));
  Outcome outcome{.summary = table_of(recovery),
                  .document = document_of(options, inputs, recovery)};
  AWMR_RETURN_IF_ERROR(write_document(command.output, outcome));
  return outcome;
}

void add_recover(CLI::App& app, Session& session) {
  auto words = std::make_shared<RecoverWords>();
  CLI::App* sub = add_command(
      app, session, "recover",
      "Simulate trials at the model's values, identify them, compare: bias and coverage",
      "awmr recover --model model.json --runs 200 -o recover.json", [words]() -> Result<Outcome> {
        AWMR_ASSIGN_OR_RETURN(const RecoverCommand command, command_of(*words));
        return execute(command);
      });
  add_runs(*sub, words->command);
  add_estimator(*sub, *words);
  add_simulated_trials(*sub, words->command.recover);
  add_file(*sub, "-o,--output", words->command.output, "recover.json to write");
}

}  // namespace awmr::cli
