#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/model/gains_file.h"
#include "commands.h"

namespace awmr::cli {

Result<Outcome> execute(const CompareCommand& command) {
  const auto model = read_model(command.model);
  if (!model) return tl::unexpected(model.error());
  const auto gains = read_gains(command.gains);
  if (!gains) return tl::unexpected(gains.error());
  std::vector<Scenario> scenarios;
  std::vector<fs::path> inputs{command.model, command.gains};
  std::vector<Fault> faults;
  for (const fs::path& path : command.scenarios) {
    inputs.push_back(path);
    const auto scenario = read_scenario(path);
    if (scenario) {
      scenarios.push_back(*scenario);
    } else {
      faults.insert(faults.end(), scenario.error().faults.begin(), scenario.error().faults.end());
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));

  Provenance provenance{"compare",
                        {{"samples", std::to_string(command.compare.samples)},
                         {"seed", std::to_string(command.compare.seed)}},
                        {}};
  for (const fs::path& path : inputs) {
    const auto input = input_file(path);
    if (!input) return tl::unexpected(input.error());
    provenance.inputs.push_back(*input);
  }
  const auto comparison =
      compare(*model, command.model.string(), *gains, scenarios, command.compare);
  if (!comparison) return tl::unexpected(comparison.error());
  if (const auto made = make_directory(command.output); !made) return tl::unexpected(made.error());
  const auto csv = write_file(command.output / "comparison.csv", comparison_csv(*comparison));
  if (!csv) return tl::unexpected(csv.error());
  const auto json = write_file(command.output / "comparison.json",
                               comparison_text(*comparison, command.compare, provenance));
  if (!json) return tl::unexpected(json.error());
  const std::string table = comparison_table(*comparison);
  return Outcome{.summary = table + fmt::format("wrote {} and comparison.csv\n",
                                                (command.output / "comparison.json").string()),
                 .brief = table};
}

void add_compare(CLI::App& app, Session& session) {
  auto command = std::make_shared<CompareCommand>();
  CLI::App* sub =
      add_command(app, session, "compare", "Compare the three yaw-control modes over scenarios",
                  "awmr compare --model model.json --gains gains.json --scenario "
                  "configs/paper/scenarios/c3_heading_steps.json -o out",
                  [command] { return execute(*command); });
  sub->add_option("--model", command->model, "model.json from identify")->required();
  sub->add_option("--gains", command->gains, "gains.json from tune")->required();
  sub->add_option("--scenario", command->scenarios, "scenario.json, one or more")->required();
  sub->add_option("--samples", command->compare.samples,
                  "Draws of the parameters from the model's covariance (default 0: nominal only)")
      ->check(CLI::Range(0, 1000000));
  sub->add_option("--seed", command->compare.seed, "Seed of the draws (default 1)");
  sub->add_option("--threads", command->compare.threads, "0 (default): one per core")
      ->check(CLI::Range(0, 1024));
  add_output(*sub, command->output, "Directory for comparison.csv and comparison.json");
}

}  // namespace awmr::cli
