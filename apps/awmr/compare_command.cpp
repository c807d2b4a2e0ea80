#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>
#include <set>

#include "awmr/core/file.h"
#include "awmr/core/input_file.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/scenario_file.h"
#include "commands.h"
#include "progress.h"

namespace awmr::cli {
namespace {

/// Set by Ctrl-C: what is running is finished, nothing more is begun.
std::atomic<bool> stop_requested = false;

/// While it lives, the first Ctrl-C asks for a stop and a second ends the program.
class StopOnInterrupt {
 public:
  StopOnInterrupt() {
    struct sigaction action = {};
    action.sa_handler = [](int) { stop_requested.store(true); };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &before_);
  }
  ~StopOnInterrupt() { sigaction(SIGINT, &before_, nullptr); }
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

 private:
  struct sigaction before_ = {};
};

/// Their file names; the paths as given where two are the same.
Result<std::vector<NamedGains>> read_all_gains(const std::vector<fs::path>& paths) {
  std::set<fs::path> names;
  for (const fs::path& path : paths) names.insert(path.filename());
  std::vector<NamedGains> all;
  std::vector<Fault> faults;
  for (const fs::path& path : paths) {
    const auto gains = read_gains(path);
    if (!gains) {
      faults.insert(faults.end(), gains.error().faults.begin(), gains.error().faults.end());
      continue;
    }
    const fs::path name = names.size() == paths.size() ? path.filename() : path;
    all.push_back({paths.size() == 1 ? "" : name.string(), *gains});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return all;
}

Result<std::vector<Scenario>> read_all_scenarios(const std::vector<fs::path>& paths) {
  std::vector<Scenario> scenarios;
  std::vector<Fault> faults;
  for (const fs::path& path : paths) {
    const auto scenario = read_scenario(path);
    if (scenario) {
      scenarios.push_back(*scenario);
    } else {
      faults.insert(faults.end(), scenario.error().faults.begin(), scenario.error().faults.end());
    }
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return scenarios;
}

Result<Provenance> provenance_of(const CompareCommand& command) {
  Provenance provenance{"compare",
                        {{"samples", std::to_string(command.compare.samples)},
                         {"seed", std::to_string(command.compare.seed)}},
                        {}};
  std::vector<fs::path> inputs{command.model};
  inputs.insert(inputs.end(), command.gains.begin(), command.gains.end());
  inputs.insert(inputs.end(), command.scenarios.begin(), command.scenarios.end());
  for (const fs::path& path : inputs) {
    const auto input = input_file(path);
    if (!input) return tl::unexpected(input.error());
    provenance.inputs.push_back(*input);
  }
  return provenance;
}

Status write_comparison(const CompareCommand& command, const Comparison& comparison,
                        const Provenance& provenance) {
  if (auto made = make_directory(command.output); !made) return made;
  auto csv = write_file(command.output / "comparison.csv", comparison_csv(comparison));
  if (!csv) return csv;
  return write_file(command.output / "comparison.json",
                    comparison_text(comparison, command.compare, provenance));
}

}  // namespace

Result<Outcome> execute(const CompareCommand& command) {
  const auto model = read_model(command.model);
  if (!model) return tl::unexpected(model.error());
  const auto gains = read_all_gains(command.gains);
  if (!gains) return tl::unexpected(gains.error());
  const auto scenarios = read_all_scenarios(command.scenarios);
  if (!scenarios) return tl::unexpected(scenarios.error());
  const auto provenance = provenance_of(command);
  if (!provenance) return tl::unexpected(provenance.error());

  CompareOptions options = command.compare;
  if (command.resume) {
    auto finished = read_finished(command.output, *provenance);
    if (!finished) return tl::unexpected(finished.error());
    options.finished = std::move(*finished);
  }
  options.stop = &stop_requested;
  const StopOnInterrupt interrupt;
  auto bar = std::make_unique<ProgressBar>(!command.quiet);
  options.progress = [&bar](std::size_t done, std::size_t total) { (*bar)(done, total); };
  const auto comparison = compare(*model, *gains, *scenarios, options);
  bar.reset();
  if (!comparison) return tl::unexpected(comparison.error());
  if (const auto written = write_comparison(command, *comparison, *provenance); !written) {
    return tl::unexpected(written.error());
  }
  if (comparison->stopped) {
    std::fputs(fmt::format("stopped: {} finished runs are in {}; the same command with --resume "
                           "goes on\n",
                           comparison->rows.size(), (command.output / "comparison.csv").string())
                   .c_str(),
               stderr);
    // The caller sees what it would have seen without the handler.
    std::signal(SIGINT, SIG_DFL);
    std::raise(SIGINT);
  }
  const std::string table = comparison_table(*comparison, command.compare.seed);
  return Outcome{.summary = table + fmt::format("wrote {} and comparison.csv\n",
                                                (command.output / "comparison.json").string()),
                 .brief = table};
}

void add_compare(CLI::App& app, Session& session) {
  auto command = std::make_shared<CompareCommand>();
  CLI::App* sub =
      add_command(app, session, "compare",
                  "Compare the three yaw-control modes, and sets of gains, over scenarios",
                  "awmr compare --model model.json --gains gains.json --scenario "
                  "configs/paper/scenarios/c3_heading_steps.json --samples 200 -o out",
                  [command] { return execute(*command); });
  sub->add_option("--model", command->model, "model.json from identify")->required();
  sub->add_option("--gains", command->gains,
                  "gains.json from tune; several to compare them with each other")
      ->required();
  sub->add_option("--scenario", command->scenarios, "scenario.json, one or more")->required();
  sub->add_option("--samples", command->compare.samples,
                  "Draws of the parameters from the model's covariance, and of noise and "
                  "disturbances (default 0: nominal only)")
      ->check(CLI::Range(0, 1000000));
  sub->add_option("--seed", command->compare.seed, "Seed of the draws (default 1)");
  sub->add_option("--threads", command->compare.threads, "0 (default): one per core")
      ->check(CLI::Range(0, 1024));
  sub->add_flag("--resume", command->resume,
                "Go on from what lies in the directory: after Ctrl-C, or with more samples");
  sub->get_option("--quiet")->each([command](const std::string&) { command->quiet = true; });
  add_output(*sub, command->output, "Directory for comparison.csv and comparison.json");
}

}  // namespace awmr::cli
