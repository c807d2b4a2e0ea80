#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <span>

#include "awmr/core/file.h"
#include "awmr/identify/planning/recover.h"
#include "awmr/identify/planning/recover_shard.h"
#include "awmr/model/model_file.h"
#include "commands.h"
#include "identify_options.h"
#include "inputs.h"
#include "option_values.h"
#include "progress.h"

namespace awmr::cli {
namespace {

struct RecoverCommand {
  fs::path model;
  RecoverOptions recover;
  ShardChoice shard = {};
  std::optional<fs::path> output = {};
};

constexpr NameTable<RecoverPlan, 3> kPlans{
    {{"tables", RecoverPlan::kTables}, {"curve", RecoverPlan::kCurve}, {"log", RecoverPlan::kLog}}};

Provenance provenance_of(const RecoverOptions& options, const std::vector<InputFile>& inputs) {
  Provenance provenance{"recover", described(options.identify), inputs};
  auto& words = provenance.options;
  words.emplace_back("plan", name_in(kPlans, options.plan));
  words.emplace_back("runs", std::to_string(options.runs));
  words.emplace_back("recover_seed", std::to_string(options.seed));
  words.emplace_back("error",
                     options.error ? name_in(kRecoverErrorNames, *options.error) : "as assumed");
  words.emplace_back("speed_noise_mps", fmt::format("{}", options.sensors.speed_mps));
  words.emplace_back("correlation_s", fmt::format("{}", options.sensors.correlation_s));
  words.emplace_back("duration_s", fmt::format("{}", options.drive.duration_s));
  words.emplace_back("rate_hz", fmt::format("{}", options.drive.rate_hz));
  return provenance;
}

/// Executes the runs of one part (shard), or all runs, with a progress bar.
Result<RecoverPart> recovered(const Model& model, const RecoverOptions& options,
                              const Shard& shard) {
  Working bar("simulating and fitting");
  return recover_part(model, options, shard, [&](int done) {
    bar(static_cast<std::size_t>(done), static_cast<std::size_t>(shard.share_of(options.runs)));
  });
}

Result<Outcome> whole_outcome(const RecoverCommand& command, const RecoverPart& whole,
                              const Provenance& provenance) {
  AWMR_ASSIGN_OR_RETURN(const Recovery recovery, recovery_of(whole));
  Outcome outcome{.summary = recovery_table(recovery),
                  .findings = recovery.findings,
                  .document = recovery_text(recovery, provenance)};
  AWMR_RETURN_IF_ERROR(write_document(command.output, outcome));
  return outcome;
}

/// Checks that the output can be written, so that an error is found before the long computation.
Status check_output_of(const RecoverCommand& command) {
  if (!command.output) return {};
  const std::span inputs(&command.model, 1);
  return command.shard ? check_outputs(*command.output, part_files(recover_shards()), inputs)
                       : check_output(*command.output, inputs);
}

/// Options as they come from the command line. CLI11 writes most of them directly into `command`.
/// The others stay texts, which command_of() parses.
struct RecoverWords {
  RecoverCommand command;
  std::optional<std::string> shard;
  std::vector<std::string> requested;
};

/// Parses the options that are kept as texts. Errors (input): an unknown parameter, or an invalid
/// part (shard).
Result<RecoverCommand> command_of(const RecoverWords& words) {
  RecoverCommand command = words.command;
  for (const std::string& name : words.requested) {
    AWMR_RETURN_IF_ERROR(add_requested(name, command.recover.identify));
  }
  AWMR_ASSIGN_OR_RETURN(command.shard, shard_of(words.shard));
  return command;
}

void add_runs(CLI::App& sub, RecoverCommand& command) {
  add_file(sub, "--model", command.model, "model.json from identify")->required();
  sub.add_option("--runs", command.recover.runs, "Simulated data sets (default 200)")
      ->check(within(2, 1000000));
  sub.add_option("--seed", command.recover.seed, "Random seed of the simulated data (default 1)")
      ->check(within<std::uint64_t>(0, kAnySeed));
  sub.add_option("--threads", command.recover.threads,
                 "Number of threads (default: all cores); the result does not depend on it")
      ->check(within(1, 1024));
}

void add_estimator(CLI::App& sub, RecoverWords& words) {
  RecoverOptions& options = words.command.recover;
  add_choice(
      sub, "--plan", options.plan, kPlans,
      "Trials to simulate. tables (default): tables like those that the model was fitted to; "
      "curve: the same tables with a coast-down curve in place of the stop times; log: "
      "only a driving log");
  add_choice(sub, "--method", options.identify.method, kMethodNames,
             "Estimator under test, as in identify");
  add_choice(sub, "--noise", options.identify.noise, kErrorModelNames,
             "Noise model of the estimator, as in identify");
  add_choice(sub, "--error", options.error, kRecoverErrorNames,
             "Quantity to which the error of table rows is added: log-force, force, speed or "
             "time (default: as the estimator assumes)");
  sub.add_option("--fit", words.requested, "Parameters to fit, as in identify")->delimiter(',');
  sub.add_flag("--joint", options.identify.joint,
               "Fit surge and coast-down together, as in identify");
}

void add_simulated_trials(CLI::App& sub, RecoverOptions& options) {
  sub.add_option("--speed-noise", options.sensors.speed_mps,
                 "Standard deviation of the simulated speed sensor, m/s (default 0.02)")
      ->check(within(0.0, 100.0));
  sub.add_option("--correlation", options.sensors.correlation_s,
                 "Correlation time of every sensor's error, s (default 0: white)")
      ->check(within(0.0, 1e4));
  sub.add_option("--duration", options.drive.duration_s, "Duration of a log, s (default 60)")
      ->check(within(1.0, 3600.0));
  sub.add_option("--rate", options.drive.rate_hz, "Rows per second of a log, Hz (default 100)")
      ->check(within(1.0, 1000.0));
}

Result<Outcome> execute(const RecoverCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const Model model, read_model(command.model));
  AWMR_ASSIGN_OR_RETURN(const std::vector<InputFile> inputs, input_files({command.model}));
  AWMR_RETURN_IF_ERROR(check_output_of(command));
  RecoverOptions options = command.recover;
  options.identify.surge_family.family = model.surge_family;
  options.identify.yaw_family.family = model.yaw_family;
  const Shard shard = command.shard.value_or(Shard{});
  const Provenance provenance = provenance_of(options, inputs);
  AWMR_ASSIGN_OR_RETURN(const RecoverPart part, recovered(model, options, shard));
  if (!command.shard) return whole_outcome(command, part, provenance);
  return written_part(recover_shards(), shard, *command.output,
                      recover_part_text(part, shard, provenance),
                      fmt::format("{} runs", part.runs.size()));
}

}  // namespace

void add_recover(CLI::App& app, Session& session) {
  auto words = std::make_shared<RecoverWords>();
  CLI::App* sub = add_command(
      app, session, "recover",
      "Simulate trials of the model, refit the model to them, report bias and interval coverage",
      "awmr recover --model model.json --runs 200 -o recover.json", [words]() -> Result<Outcome> {
        AWMR_ASSIGN_OR_RETURN(const RecoverCommand command, command_of(*words));
        return execute(command);
      });
  add_runs(*sub, words->command);
  add_estimator(*sub, *words);
  add_simulated_trials(*sub, words->command.recover);
  auto* output = add_file(*sub, "-o,--output", words->command.output,
                          "recover.json to write; with --shard, the directory of the part")
                     ->check(not_standard_output());
  add_shard(*sub, words->shard)->needs(output);
}

}  // namespace awmr::cli
