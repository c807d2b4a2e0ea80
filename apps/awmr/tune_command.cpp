#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <numeric>

#include "awmr/core/file.h"
#include "awmr/core/units.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/gains_file.h"
#include "awmr/model/model_file.h"
#include "awmr/simulate/conditions.h"
#include "awmr/simulate/validity.h"
#include "awmr/tune/tune_file.h"
#include "awmr/tune/tune_shard.h"
#include "choices.h"
#include "commands.h"
#include "inputs.h"
#include "judgement_words.h"
#include "numbers.h"
#include "paths.h"
#include "progress.h"

namespace awmr::cli {
namespace {

std::string gains_line(const char* name, const Gains<double>& gains, double objective) {
  return fmt::format(
      "  {:<14} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4f} {:>8.4f} {:>10.4f}\n", name,
      gains.heading.lambda, gains.heading.mu, gains.heading.epsilon, gains.speed.mu,
      gains.speed.epsilon, gains.heading.sliding_time_constant_s(),
      gains.heading.reaching_time_constant_s(), objective);
}

/// Table of the tuned gains and the baseline, with time constants and objective.
std::string gains_table(const Tuning& tuning) {
  std::string text =
      fmt::format("  {:<14} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10}\n", "gains", "lambda",
                  "mu", "epsilon", "mu_s", "eps_s", "T1 s", "T2 s", "objective");
  const bool is_known =
      tuning.baseline.source == kPolePlacement || tuning.baseline.source == kPaperSource;
  text += gains_line(is_known ? tuning.baseline.source.c_str() : "baseline", tuning.baseline.gains,
                     tuning.baseline_objective);
  text += gains_line("tuned", tuning.gains, tuning.objective);
  if (const ObserverGains<double>& observer = tuning.gains.observer; observer.is_on()) {
    text += fmt::format("  observer       {:.4g} rad/s, at most {:.4g} m and {:.4g} of F_max\n",
                        observer.bandwidth_radps, observer.yaw_max_m, observer.surge_max);
  }
  return text;
}

/// Lists for each metric the inputs with the largest effect on it.
std::string sensitivity_text(const RobustTuning& robust) {
  if (!robust.sensitivity) return {};
  constexpr std::size_t kMostInputs = 3;
  std::string text = fmt::format(
      "  sensitivity of the tuned loop: total Sobol indices (95 % interval), {} samples of the "
      "assumed values\n",
      robust.sensitivity->samples);
  for (const SensitiveFigure& figure : robust.sensitivity->figures) {
    std::vector<std::size_t> order(figure.by_input.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
      return figure.by_input[a].total > figure.by_input[b].total;
    });
    text += fmt::format("  {:<13} {:<17} {:.3g} +- {:.2g}:", name_of(figure.mode), figure.name,
                        figure.mean, figure.deviation);
    for (std::size_t i = 0; i < std::min(kMostInputs, order.size()); ++i) {
      const SobolIndex& index = figure.by_input[order[i]];
      text += fmt::format("{} {} {:.2f} ({:.2f} to {:.2f})", i == 0 ? "" : ";",
                          robust.sensitivity->inputs[order[i]], index.total, index.total_ci95.lo,
                          index.total_ci95.hi);
    }
    text += '\n';
  }
  return text;
}

/// Returns a warning if an observer is tuned on runs without disturbance.
std::vector<Finding> observer_findings(const TuneOptions& options) {
  const bool is_pushed = std::ranges::any_of(
      options.scenarios, [](const Scenario& scenario) { return scenario.disturbance.any(); });
  if (!options.observer || is_pushed) return {};
  return {
      {"", 0, Severity::kWarning, "observer-unpushed",
       "no scenario has a disturbance, so the observer was tuned on noise alone. Give a scenario "
       "with a disturbance, or no scenarios to use the default ones"}};
}

/// Returns a note if too few samples leave the most influential input of a metric undetermined.
std::vector<Finding> sensitivity_findings(const Tuning& tuning) {
  if (!tuning.robust || !tuning.robust->sensitivity) return {};
  constexpr double kWide = 0.5;  // an index with a 95 % interval of 0.2 to 0.7 is uninformative
  int open = 0;
  const std::vector<SensitiveFigure>& figures = tuning.robust->sensitivity->figures;
  for (const SensitiveFigure& figure : figures) {
    const auto widest = std::ranges::max_element(figure.by_input, {}, [](const SobolIndex& index) {
      return index.total_ci95.hi - index.total_ci95.lo;
    });
    open += widest->total_ci95.hi - widest->total_ci95.lo > kWide ? 1 : 0;
  }
  if (open == 0) return {};
  return {{"", 0, Severity::kNote, "sensitivity-open",
           fmt::format("{} samples do not show which input affects {} of {} metrics most; increase "
                       "--sensitivity",
                       tuning.robust->sensitivity->samples, open, figures.size())}};
}

/// Findings of the goals and of the runs, on fresh draws if there are any.
std::vector<Finding> judged_findings(const Tuning& tuning) {
  if (tuning.robust && !tuning.robust->judged.empty()) {
    std::vector<Finding> findings = goal_findings(tuning.robust->goals);
    std::ranges::move(unsettled_findings(tuning.robust->judged, tuning.robust->judged_by_scenario),
                      std::back_inserter(findings));
    return findings;
  }
  std::vector<Finding> findings;
  for (const ModeScore& score : tuning.scores) {
    note_unsettled(score.scenario, score.mode, score.metrics.completed ? 1.0 : 0.0, findings);
  }
  return findings;
}

/// A warning where some parameters of the confidence set make the loop unstable.
std::vector<Finding> certificate_findings(const Certificate& certificate) {
  std::vector<Finding> findings;
  for (const ModeCertificate& one : certificate.modes) {
    if (one.damping.value > 0.0) continue;
    std::string where;
    for (const auto& [id, value] : one.damping.parameters) {
      where += fmt::format("{}{} = {:.4g}", where.empty() ? "" : ", ", info(id).name, value);
    }
    findings.push_back(
        {"", 0, Severity::kWarning, "not-certified",
         fmt::format("{}: the heading loop is unstable for parameters within the model's 95 % set "
                     "(damping {:.3g} at {}, {:.3g} deg/s). Record the trials that `awmr suggest` "
                     "names, or raise limits/late_damping",
                     name_of(one.mode), one.damping.value, where,
                     degrees(one.damping.yaw_rate_radps))});
  }
  return findings;
}

/// Every other finding: those that a part of a tuning has as the whole has them.
std::vector<Finding> findings_before_judging(const Model& model, const Tuning& tuning,
                                             const TuneOptions& options) {
  std::vector<Finding> findings = sensitivity_findings(tuning);
  std::ranges::move(certificate_findings(*tuning.certificate), std::back_inserter(findings));
  std::ranges::move(observer_findings(options), std::back_inserter(findings));
  if (const auto plant = model.plant()) {
    if (auto finding =
            unsigned_speed_finding(*plant, tuning.gains, model.vehicle.wheel_force.hi, "")) {
      findings.push_back(std::move(*finding));
    }
  }
  std::vector<Scenario> asked = options.scenarios;
  if (tuning.robust) {
    asked.push_back(
        under(tuning.robust->conditions, {.name = "the vehicle", .guidance = OpenLoop{}}));
  }
  for (const Scenario& scenario : asked) {
    std::ranges::move(asked_in_vain(scenario, model), std::back_inserter(findings));
  }
  std::ranges::move(extrapolation_in(model, tuning.scores,
                                     [](const ModeScore& score) {
                                       return fmt::format("{}, {}", score.scenario,
                                                          name_of(score.mode));
                                     }),
                    std::back_inserter(findings));
  return findings;
}

/// Describes the active constraints and the range of equivalent gains.
std::string standing_of(const Tuning& tuning) {
  std::string held;
  for (const ActiveConstraint& one : tuning.active) {
    held += fmt::format("{}{} (limit 10 % wider: objective {:.1f} % lower)",
                        held.empty() ? "" : "; ", one.name, 100.0 * one.wider_gains);
  }
  return fmt::format(
      "  active limits  {}\n"
      "  equally good   mu {:.4g} to {:.4g} at the same mu/epsilon, mu_s {:.4g} to {:.4g} at the "
      "same mu_s/eps_s (smallest used)\n",
      held.empty() ? "none" : held, tuning.mu_as_good.lo, tuning.mu_as_good.hi,
      tuning.speed_mu_as_good.lo, tuning.speed_mu_as_good.hi);
}

/// Describes the unmodelled variation that the gains account for; empty without any.
std::string open_text(const OpenVehicle& open) {
  if (!open.any()) return {};
  std::string text = "  variation     ";
  if (!open.mass_factors.empty()) {
    text += fmt::format(" m' and I'z times {:g}", fmt::join(open.mass_factors, ", "));
  }
  for (const Interval& force : open.wheel_forces) {
    const bool first = &force == &open.wheel_forces.front();
    const char* joint = !first ? "," : open.mass_factors.empty() ? " F'" : "; F'";
    text += fmt::format("{} {:g} to {:g}", joint, force.lo, force.hi);
  }
  return text + '\n';
}

/// Worst damping and delay margin of the heading loop, over the confidence set.
std::string certificate_text(const Certificate& certificate) {
  std::string by_mode;
  for (const ModeCertificate& one : certificate.modes) {
    by_mode += fmt::format("{}{} {:.3g}, {:.3g} s", by_mode.empty() ? "" : "; ", name_of(one.mode),
                           one.damping.value, one.delay_margin_s.value);
  }
  return fmt::format(
      "  worst case     damping {:.3g}, delay margin {:.3g} s over {}, with {:g} s latency ({})\n",
      certificate.damping_min(), certificate.delay_margin_s(),
      certificate.parameters > 0 ? "the 95 % region of the parameters" : "the model's own values",
      certificate.latency_s, by_mode);
}

std::string summary_of(const Tuning& tuning, const TuneOptions& options) {
  std::string text = gains_table(tuning) + standing_of(tuning) +
                     certificate_text(*tuning.certificate) + open_text(options.open);
  if (tuning.robust) {
    text += judged_table(tuning.robust->judged, tuning.robust->judged_by_scenario) +
            goals_text(tuning.robust->goals) + sensitivity_text(*tuning.robust);
  }
  return text;
}

std::string details_of(const Tuning& tuning) {
  std::string text = "objective by scenario and mode\n";
  for (const ModeScore& score : tuning.scores) {
    text += fmt::format("  {:<22} {:<13} {:.4f} of the baseline's\n", score.scenario,
                        name_of(score.mode), score.objective);
  }
  text += "constraints\n";
  for (const ConstraintReport& constraint : tuning.constraints) {
    text += fmt::format(
        "  {:<38} {:.4g} {} {:.4g}, margin {:.4g}\n", constraint.name, constraint.value,
        constraint.sense == Sense::kAtMost ? "<=" : ">=", constraint.limit, constraint.margin);
  }
  return text + fmt::format("search\n  {} after {} evaluations: {}\n", tuning.algorithm,
                            tuning.evaluations, tuning.stop_reason);
}

Result<Tuning> tune_with_progress(const Model& model, TuneOptions options) {
  Working working("searching for gains");
  options.progress = [&](std::size_t done, std::size_t total) { working(done, total); };
  return tune(model, options);
}

Result<Provenance> provenance_of(const TuneCommand& command,
                                 const std::optional<fs::path>& baseline_file,
                                 const std::vector<fs::path>& scenario_files) {
  std::vector<fs::path> paths{command.model};
  if (command.config) paths.push_back(*command.config);
  if (baseline_file) paths.push_back(*baseline_file);
  paths.insert(paths.end(), scenario_files.begin(), scenario_files.end());
  AWMR_RETURN_IF_ERROR(
      command.shard
          ? check_outputs(command.output, {kTuneShardGains, kJudgedTable, kShardFile}, paths)
          : check_output(command.output, paths));
  AWMR_ASSIGN_OR_RETURN(std::vector<InputFile> inputs, input_files(paths, command.names));
  std::vector<std::pair<std::string, std::string>> options = options_of(command.allocation);
  if (command.nominal) options.emplace_back("nominal", "true");
  if (command.observer) options.emplace_back("observer", "true");
  if (command.baseline) options.emplace_back("baseline", command.baseline->string());
  if (command.mode) options.emplace_back("mode", std::string(name_of(*command.mode)));
  if (command.draws) options.emplace_back("draws", std::to_string(*command.draws));
  if (command.sensitivity) {
    options.emplace_back("sensitivity", std::to_string(*command.sensitivity));
  }
  for (auto& option : options_of_rate(command.heading_rate_limit)) {
    options.push_back(std::move(option));
  }
  return Provenance{"tune", std::move(options), std::move(inputs)};
}

Result<Outcome> part_outcome(const TuneCommand& command, const Tuning& tuning,
                             const TuneOptions& options, const Provenance& provenance,
                             std::vector<Finding> findings) {
  AWMR_RETURN_IF_ERROR(make_directory(command.output));
  // The last file contains the hashes of the others.
  const std::string shard_json =
      with_findings(tune_shard_text(tuning, options, provenance), findings);
  const OutputFile files[] = {
      {command.output / kTuneShardGains, gains_text(tuning, options, provenance), check_gains_text},
      {command.output / kJudgedTable, judged_csv(tuning, options),
       [&](std::string_view text, const std::string& file) {
         return check_judged_csv(text, file, shard_json);
       }},
      {command.output / kShardFile, shard_json, check_tune_shard_text}};
  AWMR_RETURN_IF_ERROR(write_files(files));
  const Shard& shard = *options.shard;
  return Outcome{
      .summary =
          gains_table(tuning) +
          fmt::format("part {} of {}: {} of {} fresh draws\nwrote {}, {} and {}\n", shard.index,
                      shard.count, shard.share_of(options.judged_draws), options.judged_draws,
                      files[2].path.string(), kJudgedTable, kTuneShardGains),
      .findings = std::move(findings),
      .document = files[2].bytes,
      .written = {files[2].path, files[1].path, files[0].path}};
}

}  // namespace

Result<Outcome> execute(const TuneCommand& command) {
  AWMR_ASSIGN_OR_RETURN(Model model, read_model(command.model));
  TuneConfig config;
  if (command.config) {
    AWMR_ASSIGN_OR_RETURN(config, read_tune_config(*command.config));
  }
  std::vector<Scenario>& scenarios = config.options.scenarios;
  if (command.observer && !config.options.observer) config.options.observer.emplace();
  if (scenarios.empty()) {
    AWMR_ASSIGN_OR_RETURN(
        scenarios, default_tuning_scenarios(model, config.options, command.heading_rate_limit));
  }
  choose(command.allocation, model, scenarios);
  AWMR_RETURN_IF_ERROR(limit_heading_rate(command.heading_rate_limit, model, scenarios));
  if (command.nominal) config.options.nominal = true;
  if (command.mode) config.options.mode = command.mode;
  if (command.draws && config.options.nominal) {
    return input_error("--draws",
                       "the configuration sets nominal, which uses no draws; remove --draws or "
                       "nominal");
  }
  if (command.draws) config.options.draws = *command.draws;
  if (command.sensitivity) config.options.sensitivity = *command.sensitivity;
  if (command.baseline) {
    AWMR_ASSIGN_OR_RETURN(config.options.baseline, baseline_named(*command.baseline));
    config.baseline_file.reset();
    if (config.options.baseline && config.options.baseline->source != kPaperSource) {
      config.baseline_file = *command.baseline;
    }
  }
  AWMR_ASSIGN_OR_RETURN(const Provenance provenance,
                        provenance_of(command, config.baseline_file, config.scenario_files));
  config.options.shard = command.shard;
  if (command.resume && is_finished_tune_shard(command.output, *command.shard, provenance)) {
    return finished_part(*command.shard, command.output);
  }
  AWMR_ASSIGN_OR_RETURN(const Tuning tuning, tune_with_progress(model, config.options));
  if (command.shard) {
    return part_outcome(command, tuning, config.options, provenance,
                        findings_before_judging(model, tuning, config.options));
  }
  std::vector<Finding> findings = judged_findings(tuning);
  std::ranges::move(findings_before_judging(model, tuning, config.options),
                    std::back_inserter(findings));
  Outcome outcome{.summary = summary_of(tuning, config.options),
                  .details = details_of(tuning),
                  .closing = fmt::format("wrote {}\n", command.output.string()),
                  .brief = gains_table(tuning),
                  .findings = std::move(findings),
                  .document = gains_text(tuning, config.options, provenance),
                  .written = {command.output}};
  put_findings_into_document(outcome);
  AWMR_RETURN_IF_ERROR(write_file(command.output, outcome.document, check_gains_text));
  return outcome;
}

void add_tune(CLI::App& app, Session& session) {
  auto command = std::make_shared<TuneCommand>();
  auto shard_text = std::make_shared<std::optional<std::string>>();
  CLI::App* sub = add_command(app, session, "tune", "Search the controller's gains under T2 < T1",
                              "awmr tune --model model.json -o gains.json",
                              [command, shard_text]() -> Result<Outcome> {
                                AWMR_ASSIGN_OR_RETURN(command->shard, shard_of(*shard_text));
                                return execute(*command);
                              });
  add_file(*sub, "--model", command->model, "model.json from identify")->required();
  add_file(*sub, "--config", command->config,
           "tune.json: mode, form, margin, limits, baseline, weights, goals, open, observer, "
           "evaluations, seed, scenarios");
  auto* nominal = sub->add_flag("--nominal", command->nominal,
                                "Tune for the nominal parameters only: no parameter draws, noise, "
                                "latency or lag");
  sub->add_flag(
      "--observer", command->observer,
      "Also tune a disturbance observer, for constant disturbances such as a slope or unequal "
      "motors");
  sub->add_option("--baseline", command->baseline,
                  "Baseline gains, with objective 1: pole-placement (default), paper or a "
                  "gains.json")
      ->type_name("NAME|FILE");
  sub->add_option_function<std::string>(
         "--mode",
         [command](const std::string& name) { command->mode = value_in(kYawModeNames, name); },
         "Tune for this mode alone (default: one set of gains for all modes)")
      ->check(one_of(names_in(kYawModeNames)));
  sub->add_option("--draws", command->draws,
                  "Number of vehicles drawn from the model's covariance to tune for (default 32)")
      ->check(within(0.0, 1000.0))
      ->excludes(nominal);
  sub->add_option("--sensitivity", command->sensitivity,
                  "Samples for a global sensitivity analysis (Sobol indices) of the tuned loop to "
                  "parameters, noise, latency and lag (default none; 256 take some seconds)")
      ->check(within(kFewestSamples, kMostSamples))
      ->excludes(nominal);
  add_allocation(*sub, command->allocation);
  add_heading_rate_limit(*sub, command->heading_rate_limit,
                         "none for --config scenarios; of the two default scenarios one is limited "
                         "to the measured rate");
  add_output(*sub, command->output, "gains.json to write; with --shard, the directory of the part");
  auto* shard = add_shard(*sub, *shard_text)->excludes(nominal);
  sub->add_flag("--resume", command->resume, "Skip a part that is already finished")->needs(shard);
}

}  // namespace awmr::cli
