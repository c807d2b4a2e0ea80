#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iterator>
#include <memory>
#include <set>

#include "awmr/compare/resume.h"
#include "awmr/compare/shard.h"
#include "awmr/core/file.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/scenario_file.h"
#include "awmr/simulate/validity.h"
#include "commands.h"
#include "gains_origin.h"
#include "inputs.h"
#include "judgement_words.h"
#include "numbers.h"
#include "paths.h"
#include "progress.h"
#include "shard_option.h"

namespace awmr::cli {
namespace {

/// Set by Ctrl-C. Runs in progress finish, no new run starts.
std::atomic<bool> stop_requested = false;

/// Handles SIGINT during its lifetime: the first requests a stop, the second has its previous
/// effect.
class StopOnInterrupt {
 public:
  StopOnInterrupt() {
    struct sigaction action = {};
    action.sa_handler = [](int) {
      stop_requested.store(true);
      sigaction(SIGINT, &before, nullptr);
    };
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, nullptr, &before);
    sigaction(SIGINT, &action, nullptr);
  }
  ~StopOnInterrupt() { sigaction(SIGINT, &before, nullptr); }
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;

 private:
  inline static struct sigaction before = {};
};

/// Names each gains file by its file name, or by its path as given if two file names are equal.
Result<std::vector<NamedGains>> read_named_gains(const std::vector<fs::path>& paths,
                                                 const Model& model) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<Gains<double>> gains,
                        read_each(paths, [&](const fs::path& path) {
                          return read_gains_for(path, model.vehicle.sample_time_s);
                        }));
  std::set<fs::path> names;
  for (const fs::path& path : paths) names.insert(path.filename());
  std::vector<NamedGains> all;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const fs::path name = names.size() == paths.size() ? paths[i].filename() : paths[i];
    all.push_back({paths.size() == 1 ? "" : name.string(), gains[i]});
  }
  return all;
}

std::vector<fs::path> inputs_of(const CompareCommand& command) {
  std::vector<fs::path> paths{command.model};
  paths.insert(paths.end(), command.gains.begin(), command.gains.end());
  paths.insert(paths.end(), command.scenarios.begin(), command.scenarios.end());
  if (command.plant.tyres_file) paths.push_back(*command.plant.tyres_file);
  return paths;
}

Result<Provenance> provenance_of(const CompareCommand& command,
                                 const std::vector<Scenario>& scenarios,
                                 const HeadingRateChoice& rate) {
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> inputs,
                        input_files(inputs_of(command), command.names));
  std::vector<std::pair<std::string, std::string>> options = options_of(command.allocation);
  options.emplace_back("samples", std::to_string(command.compare.samples));
  options.emplace_back("seed", std::to_string(command.compare.seed));
  for (auto& option : options_of_rate(rate)) options.push_back(std::move(option));
  for (auto& option : options_of(command.plant, scenarios)) options.push_back(std::move(option));
  if (command.compare.break_even) options.emplace_back("break_even", "true");
  const Preferences& preferences = command.compare.preferences;
  if (!preferences.weights.empty()) {
    std::vector<std::string> weights;
    for (const auto& [name, weight] : preferences.weights) {
      weights.push_back(fmt::format("{}={}", name, weight));
    }
    options.emplace_back("weight", fmt::format("{}", fmt::join(weights, ", ")));
  }
  if (preferences.relevance != Preferences{}.relevance) {
    options.emplace_back("relevance", fmt::format("{}", preferences.relevance));
  }
  return Provenance{"compare", std::move(options), std::move(inputs)};
}

/// Runs the comparison with a progress bar until it ends or Ctrl-C is pressed.
Result<Comparison> compare_until_interrupted(const Model& model,
                                             const std::vector<NamedGains>& gains,
                                             const std::vector<Scenario>& scenarios,
                                             CompareOptions options) {
  Working bar("comparing");
  options.stop = &stop_requested;
  options.progress = [&bar](std::size_t done, std::size_t total) { bar(done, total); };
  return compare(model, gains, scenarios, options);
}

/// Name of the JSON file with the inputs and the results of comparison.csv.
const char* json_of(const CompareCommand& command) {
  return command.shard ? "shard.json" : "comparison.json";
}

/// Returns the content of the file with that name.
std::string document_of(const CompareCommand& command, const Comparison& comparison,
                        const Provenance& provenance) {
  return command.shard ? shard_text(comparison, command.compare, provenance)
                       : comparison_text(comparison, command.compare, provenance);
}

Status write_comparison(const CompareCommand& command, const Comparison& comparison,
                        const std::string& text) {
  AWMR_RETURN_IF_ERROR(make_directory(command.output));
  // comparison.json or shard.json is written last because it contains the hash of the table.
  const OutputFile files[] = {
      {command.output / "comparison.csv", comparison_csv(comparison), check_comparison_csv},
      {command.output / json_of(command), text,
       command.shard ? check_shard_text : check_comparison_text}};
  return write_files(files);
}

/// Prints how to resume, then ends the program by the signal, so that the caller sees the usual
/// exit status.
void end_interrupted(const CompareCommand& command, const Comparison& comparison) {
  const std::string file = (command.output / "comparison.csv").string();
  const std::string text =
      command.shard ? "stopped: run the whole part of the comparison again\n"
                    : fmt::format("stopped: {} finished runs are in {}; continue with --resume\n",
                                  comparison.rows.size(), file);
  std::fputs(text.c_str(), stderr);
  std::signal(SIGINT, SIG_DFL);
  std::raise(SIGINT);
}

/// Option values as typed, parsed when the command runs.
struct Texts {
  std::optional<std::string> shard;
  std::vector<std::string> weights;
  double relevance = Preferences{}.relevance;
};

Status read_texts(const Texts& texts, CompareCommand& command) {
  AWMR_ASSIGN_OR_RETURN(command.shard, shard_of(texts.shard));
  command.compare.shard = command.shard.value_or(Shard{});
  if (command.shard && command.compare.break_even) {
    return input_error("--break-even", "cannot be combined with --shard");
  }
  AWMR_ASSIGN_OR_RETURN(command.compare.preferences,
                        preferences_of(texts.weights, texts.relevance));
  return {};
}

void add_preferences(CLI::App& command, Texts& texts) {
  command.add_option(
      "--weight", texts.weights,
      "NAME=WEIGHT of a metric in the ranking, 0 to 1000, may be repeated: finish_time_s=3, "
      "energy_electric=1 (default 1 for heading_iae_degs, cross_track_rms_m, settling_time_s, "
      "finish_time_s, speed_drop_mps, energy_mech and tyre_work, 0 for the others)");
  command
      .add_option("--relevance", texts.relevance,
                  "Relative difference of a metric or score below which modes are equivalent "
                  "(default 0.05)")
      ->check(within(0.0, 1.0));
}

/// Describes the heading-rate limit, with the rate that the model gives.
std::string rate_in_words(const HeadingRateChoice& rate, const Model& model) {
  if (rate != kMeasuredRate) return words_of_rate(rate);
  return fmt::format(
      "heading commands limited to {:.3g} deg/s, the highest yaw rate of the turning trials\n"
      "(--heading-rate-limit {}: no limit but the scenarios' own)\n",
      *measured_yaw_rate_degps(model), kNoRate);
}

/// Adds the finding on the simulated scrub, or a warning if yaw resistance includes scrub that
/// steered turns do not have.
void note_scrub(const Model& model, std::vector<Finding>& findings) {
  if (model.yaw_by_sides_alone) {
    findings.push_back(
        {model.file, 0, Severity::kWarning, "turned-by-sides",
         "yaw resistance was identified from differential turns and includes their tyre scrub, so "
         "steering and combined appear worse than they are. Add steered turns to the turning table "
         "(awmr suggest lists them)"});
  }
  if (!model.yaw_scrub || !(model.yaw_scrub->moment_m > 0.0)) return;
  findings.push_back(
      {model.file, 0, Severity::kNote, "scrub-simulated",
       fmt::format("the simulated plant adds the measured tyre scrub, {:.3g} m (95 %: {:.3g} to "
                   "{:.3g}), to differential and combined turns; the controller does not "
                   "compensate it. --break-even gives the scrub that changes each ranking",
                   model.yaw_scrub->moment_m, model.yaw_scrub->ci95_m.lo,
                   model.yaw_scrub->ci95_m.hi)});
}

/// Adds all findings except the one on the fastest turn. They are the same for a shard and the
/// whole.
Status add_findings(const CompareCommand& command, const Comparison& comparison, const Model& model,
                    const std::vector<Scenario>& scenarios, std::vector<Finding>& findings) {
  for (const fs::path& gains : command.gains) {
    AWMR_RETURN_IF_ERROR(note_other_model(gains, command.model, findings));
  }
  for (const Scenario& scenario : scenarios) {
    std::ranges::move(asked_in_vain(scenario, model), std::back_inserter(findings));
    if (auto finding = tyres_differ(scenario, model)) findings.push_back(*finding);
  }
  const int samples = command.shard ? command.compare.samples : comparison.whole_samples - 1;
  if (samples >= 2 && samples < kFewSamples) {
    findings.push_back(
        {"", 0, Severity::kWarning, "few-samples",
         fmt::format("intervals of {} samples have a coverage of at most {:.0f} %, not 95; give {} "
                     "samples or more",
                     samples, 100.0 * (1.0 - std::pow(0.5, samples - 1)), kFewSamples)});
  }
  if (auto finding = not_led(command.heading_rate_limit, model)) findings.push_back(*finding);
  note_scrub(model, findings);
  return {};
}

Outcome outcome_of_part(const CompareCommand& command, const Comparison& part,
                        std::vector<Finding> findings) {
  return {.summary = fmt::format("part {} of {}: {} runs\nwrote {} and comparison.csv\n",
                                 command.compare.shard.index, command.compare.shard.count,
                                 part.rows.size(), (command.output / json_of(command)).string()),
          .findings = std::move(findings)};
}

Outcome outcome_of_whole(const CompareCommand& command, const Comparison& comparison,
                         const Model& model, const std::vector<Scenario>& scenarios,
                         const HeadingRateChoice& rate, const Provenance& provenance,
                         std::vector<Finding> more) {
  std::string table = comparison_table(comparison, command.compare) + rate_in_words(rate, model);
  for (const auto& [name, text] : options_of(command.plant, scenarios)) {
    table += fmt::format("{}: {}\n", name, text);
  }
  std::vector<Finding> findings = extrapolation_findings(comparison, provenance);
  std::ranges::move(more, std::back_inserter(findings));
  return {.summary = table + fmt::format("wrote {} and comparison.csv\n",
                                         (command.output / json_of(command)).string()),
          .brief = table,
          .findings = std::move(findings)};
}

}  // namespace

Result<Outcome> execute(const CompareCommand& command) {
  AWMR_ASSIGN_OR_RETURN(Model model, read_model(command.model));
  AWMR_ASSIGN_OR_RETURN(const std::vector<NamedGains> gains,
                        read_named_gains(command.gains, model));
  AWMR_ASSIGN_OR_RETURN(std::vector<Scenario> scenarios,
                        read_each(command.scenarios, read_scenario));
  choose(command.allocation, model, scenarios);
  std::vector<Finding> findings;
  AWMR_ASSIGN_OR_RETURN(const Tyres<double> tyres, tyres_of(command.plant, findings));
  AWMR_RETURN_IF_ERROR(choose(command.plant, tyres, scenarios));
  const HeadingRateChoice rate = rate_to_compare_at(command.heading_rate_limit, model);
  AWMR_RETURN_IF_ERROR(limit_heading_rate(rate, model, scenarios));
  AWMR_ASSIGN_OR_RETURN(const Provenance provenance, provenance_of(command, scenarios, rate));
  AWMR_RETURN_IF_ERROR(
      check_outputs(command.output, {"comparison.csv", json_of(command)}, inputs_of(command)));
  CompareOptions options = command.compare;
  options.other_settings = !command.plant.kind;
  options.tyres = tyres;
  if (command.resume && command.shard) {
    if (is_finished_shard(command.output, options, provenance)) {
      return finished_part(*command.shard, command.output);
    }
  } else if (command.resume) {
    AWMR_ASSIGN_OR_RETURN(options.finished, read_finished(command.output, provenance));
  }
  const StopOnInterrupt interrupt;
  AWMR_ASSIGN_OR_RETURN(const Comparison comparison,
                        compare_until_interrupted(model, gains, scenarios, std::move(options)));
  AWMR_RETURN_IF_ERROR(add_findings(command, comparison, model, scenarios, findings));
  Outcome outcome = command.shard ? outcome_of_part(command, comparison, std::move(findings))
                                  : outcome_of_whole(command, comparison, model, scenarios, rate,
                                                     provenance, std::move(findings));
  outcome.document = document_of(command, comparison, provenance);
  put_findings_into_document(outcome);
  AWMR_RETURN_IF_ERROR(write_comparison(command, comparison, outcome.document));
  if (comparison.stopped) end_interrupted(command, comparison);
  outcome.written = {command.output / json_of(command), command.output / "comparison.csv"};
  return outcome;
}

void add_compare(CLI::App& app, Session& session) {
  auto command = std::make_shared<CompareCommand>();
  auto texts = std::make_shared<Texts>();
  CLI::App* sub =
      add_command(app, session, "compare",
                  "Compare the three yaw-control modes, and sets of gains, over scenarios",
                  "awmr compare --model model.json --gains gains.json --scenario "
                  "configs/paper/scenarios/c3_heading_steps.json --samples 20 -o comparison",
                  [command, texts]() -> Result<Outcome> {
                    AWMR_RETURN_IF_ERROR(read_texts(*texts, *command));
                    return execute(*command);
                  });
  add_file(*sub, "--model", command->model, "model.json from identify")->required();
  add_file(*sub, "--gains", command->gains,
           "gains.json from tune; several to compare them with each other")
      ->required();
  add_file(*sub, "--scenario", command->scenarios, "scenario.json, one or more")->required();
  sub->add_option("--samples", command->compare.samples,
                  "Random draws of parameters (from the model's covariance), noise and "
                  "disturbances (default 0: nominal only)")
      ->check(within(0, 1000000));
  sub->add_option("--seed", command->compare.seed, "Seed of the draws (default 1)")
      ->check(within<std::uint64_t>(0, kAnySeed));
  sub->add_option("--threads", command->compare.threads, "0 (default): one per core")
      ->check(within(0, 1024));
  sub->add_flag("--resume", command->resume,
                "Continue from the results in the directory, after Ctrl-C or with more samples; "
                "with --shard, skip a finished part");
  add_preferences(*sub, *texts);
  sub->add_flag(
      "--break-even", command->compare.break_even,
      "Also compute the tyre scrub of differential turns at which a steering mode becomes better");
  add_shard(*sub, texts->shard);
  add_allocation(*sub, command->allocation);
  add_heading_rate_limit(*sub, command->heading_rate_limit, "measured, if the model has that rate");
  add_plant_or_both(*sub, command->plant);
  add_output_directory(*sub, command->output, "Directory for comparison.csv and comparison.json");
}

}  // namespace awmr::cli
