#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <set>

#include "awmr/compare/compare_findings.h"
#include "awmr/compare/comparison_directory.h"
#include "awmr/compare/shard.h"
#include "awmr/core/file.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/scenario_file.h"
#include "commands.h"
#include "gains_origin.h"
#include "inputs.h"
#include "option_values.h"
#include "progress.h"
#include "shard_option.h"
#include "stop_on_interrupt.h"
#include "unstable_gains.h"

namespace awmr::cli {
namespace {

/// Reads the gains files. Each set of gains is named by its file name, or by its path as given if
/// two file names are equal.
Result<std::vector<NamedGains>> read_named_gains(const std::vector<fs::path>& paths,
                                                 const Model& model) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<ModeGains> gains,
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

/// Inputs of a comparison, after the command-line options have been applied to them.
struct ComparedInputs {
  Model model;
  std::vector<NamedGains> gains;
  std::vector<Scenario> scenarios;
  Tyres<double> tyres;
  HeadingRateChoice rate;
  std::string equipment;  ///< equipment_text() of the scenarios
  std::vector<Finding> findings;
};

Result<ComparedInputs> read_inputs(const CompareCommand& command) {
  ComparedInputs inputs;
  AWMR_ASSIGN_OR_RETURN(inputs.model, read_model(command.model));
  AWMR_ASSIGN_OR_RETURN(inputs.gains, read_named_gains(command.gains, inputs.model));
  AWMR_ASSIGN_OR_RETURN(inputs.scenarios, read_each(command.scenarios, read_scenario));
  choose(command.allocation, inputs.model, inputs.scenarios);
  AWMR_ASSIGN_OR_RETURN(inputs.tyres, tyres_of(command.plant, inputs.findings));
  AWMR_RETURN_IF_ERROR(choose(command.plant, inputs.tyres, inputs.scenarios));
  inputs.rate = rate_to_compare_at(command.heading_rate_limit, inputs.model);
  AWMR_RETURN_IF_ERROR(limit_heading_rate(inputs.rate, inputs.model, inputs.scenarios));
  inputs.equipment = equipment_text(inputs.model.vehicle, inputs.scenarios);
  inputs.scenarios = equipped(inputs.model.vehicle, std::move(inputs.scenarios));
  return inputs;
}

std::vector<fs::path> inputs_of(const CompareCommand& command) {
  return all_paths(command.model, command.gains, command.scenarios, command.plant.tyres_file);
}

Result<Provenance> provenance_of(const CompareCommand& command, const ComparedInputs& compared) {
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> inputs,
                        input_files(inputs_of(command), command.names));
  NamedOptions options;
  describe_allocation(command.allocation, options);
  options.emplace_back("samples", std::to_string(command.compare.samples));
  options.emplace_back("seed", std::to_string(command.compare.seed));
  describe_rate(compared.rate, options);
  describe_plant(command.plant, compared.scenarios, options);
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

/// Runs the comparison with a progress bar, until it ends or the user presses Ctrl-C.
Result<Comparison> compare_until_interrupted(const ComparedInputs& inputs, CompareOptions options) {
  const StopOnInterrupt interrupt;
  Working bar("comparing");
  options.stop = &StopOnInterrupt::requested();
  options.progress = [&bar](std::size_t done, std::size_t total) { bar(done, total); };
  return compare(inputs.model, inputs.gains, inputs.scenarios, options);
}

/// Values of options as text, which read_texts() parses when the command runs.
struct Texts {
  std::optional<std::string> shard;
  std::vector<std::string> weights;
  double relevance = Preferences{}.relevance;
};

Status read_texts(const Texts& texts, CompareCommand& command) {
  AWMR_ASSIGN_OR_RETURN(command.shard, shard_of(texts.shard));
  command.compare.shard = command.shard.value_or(Shard{});
  if (command.shard && command.compare.break_even) {
    return input_error(ErrorCode::kConflict, "--break-even",
                       "cannot be combined with --shard; remove one of them");
  }
  AWMR_ASSIGN_OR_RETURN(command.compare.preferences,
                        preferences_of(texts.weights, texts.relevance));
  return {};
}

void add_samples(CLI::App& command, CompareOptions& options) {
  command
      .add_option(
          "--samples", options.samples,
          "Number of simulated vehicles, each with randomly drawn parameters (from the model's "
          "covariance), noise and disturbances (default 0: one run with the model's own "
          "values)")
      ->check(within(0, 1000000));
  command.add_option("--seed", options.seed, "Seed of the draws (default 1)")
      ->check(within<std::uint64_t>(0, kAnySeed));
  command.add_option("--threads", options.threads, "Number of threads; 0 (default): one per core")
      ->check(within(0, 1024));
}

void add_preferences(CLI::App& command, Texts& texts) {
  command.add_option(
      "--weight", texts.weights,
      "NAME=WEIGHT: weight of a metric in the ranking, 0 to 1000, such as finish_time_s=3; may be "
      "repeated (default 1 for heading_iae_degs, cross_track_rms_m, settling_time_s, "
      "finish_time_s, speed_drop_mps, energy_mech and tyre_work, 0 for other metrics)");
  command
      .add_option("--relevance", texts.relevance,
                  "Relative difference of a metric or score below which modes are equivalent, at "
                  "least 0.001, so that rounding decides no rank (default 0.05)")
      ->check(within(kRelevance.min, kRelevance.max));
}

/// Describes the heading-rate limit; for 'measured', with the number from the model.
std::string rate_in_words(const HeadingRateChoice& rate, const Model& model) {
  if (rate != kMeasuredRate) return words_of_rate(rate);
  return fmt::format(
      "heading commands limited to {:.3g} deg/s, the highest measured yaw rate\n"
      "(--heading-rate-limit {}: only the limits in the scenarios)\n",
      *measured_yaw_rate_degps(model), kNoRate);
}

/// Returns the findings about the inputs and the comparison, which may be a part (--shard).
Result<std::vector<Finding>> findings_of(const CompareCommand& command,
                                         const ComparedInputs& inputs,
                                         const Comparison& comparison) {
  std::vector<Finding> findings = inputs.findings;
  for (std::size_t i = 0; i < command.gains.size(); ++i) {
    AWMR_RETURN_IF_ERROR(note_other_model(command.gains[i], command.model, findings));
    note_unstable(inputs.model, inputs.gains[i].gains, command.gains[i], inputs.scenarios,
                  findings);
  }
  std::ranges::move(compare_findings(inputs.model, inputs.scenarios, command.compare, comparison,
                                     command.heading_rate_limit),
                    std::back_inserter(findings));
  return findings;
}

/// Returns the table of a whole comparison (no --shard), followed by the heading-rate limit and the
/// simulated vehicle model.
std::string table_of(const CompareCommand& command, const ComparedInputs& inputs,
                     const Comparison& comparison) {
  std::string table =
      comparison_table(comparison, command.compare) + rate_in_words(inputs.rate, inputs.model);
  table += inputs.equipment;
  NamedOptions plant;
  describe_plant(command.plant, inputs.scenarios, plant);
  for (const auto& [name, text] : plant) {
    table += fmt::format("{}: {}\n", name, text);
  }
  return table;
}

Result<Outcome> part_outcome(const CompareCommand& command, const Comparison& part,
                             const Provenance& provenance, std::vector<Finding> findings) {
  const PartText text = comparison_part(part, command.compare, provenance, findings);
  return written_part(comparison_shards(), *command.shard, command.output, text,
                      fmt::format("{} runs", part.rows.size()), std::move(findings));
}

Result<Outcome> whole_outcome(const CompareCommand& command, const ComparedInputs& inputs,
                              const Comparison& comparison, const Provenance& provenance,
                              const std::vector<Finding>& findings) {
  Outcome outcome{.brief = table_of(command, inputs, comparison),
                  .findings = completion_findings(comparison),
                  .document = comparison_text(comparison, command.compare, provenance)};
  std::ranges::move(extrapolation_findings(comparison, provenance),
                    std::back_inserter(outcome.findings));
  std::ranges::copy(findings, std::back_inserter(outcome.findings));
  put_findings_into_document(outcome);
  AWMR_RETURN_IF_ERROR(write_comparison(command.output, comparison, outcome.document));
  outcome.written = {command.output / kComparisonJson, command.output / kComparisonTable};
  outcome.summary = outcome.brief + fmt::format("wrote {} and {}\n",
                                                outcome.written.front().string(), kComparisonTable);
  return outcome;
}

/// Checks the output files before the long computation, so that errors are found early. Errors
/// (input): an output cannot be written, or is an input.
Status check_outputs_of(const CompareCommand& command) {
  return cli::check_outputs(command.output,
                            command.shard
                                ? part_files(comparison_shards())
                                : std::vector<std::string>{kComparisonTable, kComparisonJson},
                            inputs_of(command));
}

}  // namespace

Result<Outcome> execute(const CompareCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const ComparedInputs inputs, read_inputs(command));
  AWMR_ASSIGN_OR_RETURN(const Provenance provenance, provenance_of(command, inputs));
  AWMR_RETURN_IF_ERROR(check_outputs_of(command));
  CompareOptions options = command.compare;
  options.other_settings = command.plant.runs_other();
  options.tyres = inputs.tyres;
  AWMR_ASSIGN_OR_RETURN(const Comparison comparison,
                        compare_until_interrupted(inputs, std::move(options)));
  if (command.shard && comparison.stopped) {
    end_interrupted("stopped: nothing is written; run this part again");
  }
  AWMR_ASSIGN_OR_RETURN(std::vector<Finding> findings, findings_of(command, inputs, comparison));
  Result<Outcome> outcome = command.shard
                                ? part_outcome(command, comparison, provenance, std::move(findings))
                                : whole_outcome(command, inputs, comparison, provenance, findings);
  if (outcome && comparison.stopped) {
    end_interrupted(fmt::format("stopped: {} finished runs are in {}", comparison.rows.size(),
                                (command.output / kComparisonTable).string()));
  }
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
  add_samples(*sub, command->compare);
  add_preferences(*sub, *texts);
  sub->add_flag("--break-even", command->compare.break_even,
                "Also compute the break-even tyre scrub: the constant yaw moment against "
                "differential turns at which a better mode is no longer better than a mode with "
                "smaller differences between left and right force");
  add_shard(*sub, texts->shard);
  add_allocation(*sub, command->allocation);
  add_heading_rate_limit(*sub, command->heading_rate_limit, "measured, if the model has that rate");
  add_plant_or_both(*sub, command->plant);
  add_output_directory(*sub, command->output, "Directory for comparison.csv and comparison.json");
}

}  // namespace awmr::cli
