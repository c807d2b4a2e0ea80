#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/model/model_file.h"
#include "awmr/tune/tune_file.h"
#include "commands.h"
#include "inputs.h"

namespace awmr::cli {
namespace {

std::string gains_line(const char* name, const Gains<double>& gains, double objective) {
  return fmt::format(
      "  {:<10} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4f} {:>8.4f} {:>10.4f}\n", name,
      gains.heading.lambda, gains.heading.mu, gains.heading.epsilon, gains.speed.mu,
      gains.speed.epsilon, gains.heading.sliding_time_constant_s(),
      gains.heading.reaching_time_constant_s(), objective);
}

/// The tuned gains under the paper's, with their time constants and objective.
std::string gains_table(const Tuning& tuning) {
  std::string text =
      fmt::format("  {:<10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10}\n", "gains", "lambda",
                  "mu", "epsilon", "mu_s", "eps_s", "T1 s", "T2 s", "objective");
  text += gains_line("paper", tuning.baseline, tuning.baseline_objective);
  text += gains_line("tuned", tuning.gains, tuning.objective);
  return text;
}

std::string summary_of(const TuneCommand& command, const Tuning& tuning) {
  std::string text = gains_table(tuning);
  for (const ModeScore& score : tuning.scores) {
    text += fmt::format("    {:<22} {:<13} {:.4f} of the paper's gains'\n", score.scenario,
                        name_of(score.mode), score.objective);
  }
  for (const ConstraintReport& constraint : tuning.constraints) {
    text += fmt::format("    {:<38} {:.4g} <= {:.4g}, margin {:.4g}\n", constraint.name,
                        constraint.value, constraint.limit, constraint.margin);
  }
  text += fmt::format("  {} after {} evaluations: {}\n", tuning.algorithm, tuning.evaluations,
                      tuning.stop_reason);
  return text + fmt::format("wrote {}\n", command.output.string());
}

Result<Provenance> provenance_of(const TuneCommand& command,
                                 const std::vector<fs::path>& scenario_files) {
  std::vector<fs::path> paths{command.model};
  if (command.config) paths.push_back(*command.config);
  paths.insert(paths.end(), scenario_files.begin(), scenario_files.end());
  AWMR_RETURN_IF_ERROR(check_output(command.output, paths));
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> inputs, input_files(paths, command.names));
  return Provenance{"tune", {}, std::move(inputs)};
}

}  // namespace

Result<Outcome> execute(const TuneCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const Model model, read_model(command.model));
  TuneConfig config;
  if (command.config) {
    AWMR_ASSIGN_OR_RETURN(config, read_tune_config(*command.config));
  }
  AWMR_ASSIGN_OR_RETURN(const Provenance provenance, provenance_of(command, config.scenario_files));
  AWMR_ASSIGN_OR_RETURN(const Tuning tuning, tune(model, config.options));
  AWMR_RETURN_IF_ERROR(write_file(command.output, gains_text(tuning, config.options, provenance)));
  return Outcome{.summary = summary_of(command, tuning), .brief = gains_table(tuning)};
}

void add_tune(CLI::App& app, Session& session) {
  auto command = std::make_shared<TuneCommand>();
  CLI::App* sub = add_command(app, session, "tune", "Search the controller's gains under T2 < T1",
                              "awmr tune --model model.json -o gains.json",
                              [command] { return execute(*command); });
  sub->add_option("--model", command->model, "model.json from identify")->required();
  sub->add_option("--config", command->config,
                  "tune.json: form, margin, weights, evaluations, seed, scenarios");
  add_output(*sub, command->output, "gains.json to write");
}

}  // namespace awmr::cli
