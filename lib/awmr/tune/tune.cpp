#include "awmr/tune/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/baseline_limits.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/settling.h"
#include "awmr/tune/tuning_context.h"
#include "awmr/tune/tuning_steps.h"
#include "awmr/tune/turning.h"
#include "awmr/tune/unsettled_cause.h"

namespace awmr {
namespace {

/// Gains with which runs settle only in a longer time can be slow because of the limits of the
/// damping. If relaxing such a limit lets the runs settle, reports the changes with which they
/// settle as the cause, in place of the noise.
void replace_by_damping(const ObjectiveSetting& setting, const Gains<double>& gains,
                        SettlingSearch& search, UnsettledRuns& unsettled) {
  if (!(unsettled.noise->time_factor > 1.0)) return;
  std::vector<SettlingChange> changes = search.changes(setting, gains, kSettledShare);
  const auto is_of_damping = [](const SettlingChange& change) {
    return change.pointer.ends_with("damping");
  };
  if (std::ranges::none_of(changes, is_of_damping)) return;
  unsettled.noise.reset();
  unsettled.changes = std::move(changes);
}

/// Returns why runs do not settle in one scenario and mode, and the changes with which they settle.
/// To save time, it tries causes and changes of the gains only on the nominal vehicle and the first
/// drawn vehicles. `is_varied`: the drawn vehicles have unmodelled variation. Errors of the
/// identified parameters are then not tried as a cause.
UnsettledRuns unsettled_in(const ObjectiveSetting& setting, const ConstraintContext& context,
                           const Gains<double>& gains, bool is_varied, SettlingSearch& search) {
  const YawMode mode = *setting.mode;
  UnsettledRuns unsettled{.scenario = {}, .mode = mode};
  const Status turns =
      check_turning(context.own(), std::span(&mode, 1), setting.scenarios, std::string());
  if (!turns) {
    unsettled.why = turns.error().faults.front().message;
    return unsettled;
  }
  const ObjectiveSetting few = on_few_vehicles(setting);
  unsettled.vehicles = few.vehicles.size();
  unsettled.friction = friction_effect(few, gains, mode);
  unsettled.noise = noise_effect(few, gains);
  if (unsettled.noise) {
    replace_by_damping(few, gains, search, unsettled);
    return unsettled;
  }
  if (few.vehicles.size() > 1 && !is_varied) {
    unsettled.error = unsettling_error(few, gains);
    if (!unsettled.error) unsettled.noise = noise_effect_on_identified(few, gains);
    if (unsettled.noise) return unsettled;
  }
  unsettled.changes = scenario_changes(setting, gains, kSettledShare);
  if (!unsettled.error || unsettled.error->share_of_identified < kSettledShare) {
    std::ranges::move(search.changes(few, gains, kSettledShare),
                      std::back_inserter(unsettled.changes));
  }
  return unsettled;
}

/// Returns unsettled_in() for each scenario and mode in which fewer than 95 % of the runs settle.
std::vector<UnsettledRuns> unsettled_runs(const Tuning& tuning, const ObjectiveSetting& setting,
                                          const ConstraintContext& context, bool is_varied) {
  std::vector<UnsettledRuns> all;
  SettlingSearch search(context);
  const auto look_at = [&](const std::string& scenario, YawMode mode, double settled_share) {
    if (settled_share >= kSettledShare) return;
    all.push_back(
        unsettled_in(runs_in(setting, scenario, mode), context, tuning.gains, is_varied, search));
    all.back().scenario = scenario;
    all.back().settled_share = settled_share;
  };
  if (tuning.robust && !tuning.robust->evaluated.empty()) {
    const RobustTuning& robust = *tuning.robust;
    for (const EvaluatedGains& one :
         robust.evaluated_by_scenario.empty() ? robust.evaluated : robust.evaluated_by_scenario) {
      if (one.gains == kRobustGains) look_at(one.scenario, one.mode, one.completed_share);
    }
  } else {
    for (const ModeScore& score : tuning.scores) {
      look_at(score.scenario, score.mode, score.metrics.completed ? 1.0 : 0.0);
    }
  }
  return all;
}

/// Error (input) if the latency exceeds kMaxLatencySamples: the work for a constraint grows with
/// the cube of the latency in samples.
Status check_latency(const ConstraintContext& context, const std::string& model_file) {
  const double samples = context.latency_s / context.sample_time_s;
  if (samples < kMaxLatencySamples + 1e-9) return {};
  return input_error(
      ErrorCode::kTooLarge, model_file + ":/vehicle/latency_s",
      fmt::format(
          "the latency of {:g} s is {:.4g} samples of {:g} s, more than the limit of {} "
          "samples; give a longer sample_time_s, or tune without latency, noise and lag ({})",
          context.latency_s, samples, context.sample_time_s, kMaxLatencySamples,
          option_text("nominal")));
}

/// XORed with the seed, to evaluate the tuned gains on vehicles that the search did not use.
constexpr std::uint64_t kEvaluationSeeds = 0x6a75646765ULL;

std::vector<NamedCandidate> candidates_of(const Tuning& tuning) {
  std::vector<NamedCandidate> candidates{{kRobustGains, tuning.gains},
                                         {"baseline", tuning.baseline.gains.common()}};
  if (tuning.baseline.source != kPaperSource) candidates.push_back({"paper", kPaperGains});
  if (tuning.gains.observer.is_on()) {
    Gains<double> unobserved = tuning.gains;
    unobserved.observer = {};
    candidates.push_back({"unobserved", unobserved});
  }
  return candidates;
}

/// Evaluates `candidates` on newly drawn vehicles, and adds the statistics to `robust`.
Status evaluate_candidates(const Model& model, ObjectiveSetting setting, const TuneOptions& options,
                           const std::vector<NamedCandidate>& candidates, RobustTuning& robust) {
  if (options.evaluation_draws == 0) return {};
  setting.seed ^= kEvaluationSeeds;
  AWMR_ASSIGN_OR_RETURN(setting.vehicles, vehicles_of(model, options.evaluation_draws, setting.seed,
                                                      options.open, Spread::kRandom));
  const std::vector<EvaluatedRuns> runs = run_candidates(setting, candidates);
  const std::span<const YawMode> modes = setting.modes();
  std::vector<std::string> names;
  for (const Scenario& scenario : setting.scenarios) names.push_back(scenario.name);
  EvaluationResult evaluation = evaluation_of(runs, {.modes = {modes.begin(), modes.end()},
                                                     .scenarios = std::move(names),
                                                     .tail_share = options.tail_share,
                                                     .goals = options.goals});
  robust.evaluated = std::move(evaluation.gains);
  robust.evaluated_by_scenario = std::move(evaluation.by_scenario);
  robust.goals = std::move(evaluation.goals);
  return {};
}

/// Inputs of the search, for all modes: the setting of the runs and the context of the constraints.
struct TuningProblem {
  ObjectiveSetting setting;
  ConstraintContext context;
  std::optional<RobustTuning> robust;  ///< without results; absent for nominal gains
};

/// Adds drawn vehicles, sensor noise, latency and motor lag to a nominal problem.
Status add_draws(const Model& model, const TuneOptions& options, TuningProblem& problem) {
  auto& [setting, context, robust] = problem;
  robust = RobustTuning{.conditions = conditions_of(model.vehicle),
                        .from_covariance = !model.covariance.parameters.empty(),
                        .evaluated = {},
                        .evaluated_by_scenario = {},
                        .goals = {}};
  const LoopConditions& c = robust->conditions;
  AWMR_ASSIGN_OR_RETURN(setting.vehicles, vehicles_of(model, options.draws, options.seed,
                                                      options.open, Spread::kEven));
  for (Scenario& scenario : setting.scenarios) scenario = under(c, std::move(scenario));
  setting.goals = options.goals;
  context.draws.assign(setting.vehicles.begin() + 1, setting.vehicles.end());
  add_conditions(c, context);
  return check_latency(context, model.file);
}

/// Tunes for one mode, or for all modes if `mode` is absent.
Result<Tuning> tune_for(std::optional<YawMode> mode, const Model& model, TuningProblem problem,
                        TuneOptions options, const Scenario& held_out) {
  auto& [setting, context, robust] = problem;
  options.mode = setting.mode = context.mode = mode;
  if (robust) limit_steering_rate(context);
  AWMR_ASSIGN_OR_RETURN(Tuning tuning, search_gains(model, setting, context, options, held_out));
  tuning.mode = mode;
  if (robust) {
    AWMR_RETURN_IF_ERROR(
        evaluate_candidates(model, setting, options, candidates_of(tuning), *robust));
    tuning.robust = std::move(robust);
  }
  const bool is_varied = tuning.robust && options.open.combinations() > 1;
  tuning.unsettled = unsettled_runs(tuning, setting, context, is_varied);
  return tuning;
}

/// ModeTuning::compare_with_baseline: computes again the results of `tuning` for one mode that
/// depend on its baseline.
Status compare_with_baseline(const Model& model, TuningProblem problem, const TuneOptions& options,
                             Tuning& tuning) {
  auto& [setting, context, robust] = problem;
  setting.mode = context.mode = tuning.mode;
  if (robust) limit_steering_rate(context);
  const Gains<double>& baseline = tuning.baseline.gains.common();
  tuning.baseline_violates =
      violated_by_baseline(baseline, Objective(setting, baseline), context, options);
  if (!tuning.robust) return {};
  return evaluate_candidates(model, setting, options, candidates_of(tuning), *tuning.robust);
}

/// Largest number of RK4 steps of a search. This many steps take some hours.
constexpr double kMaxSearchSteps = 1e11;

/// Expected duration on two cores, s, above which a search is announced.
constexpr double kLongSearch_s = 10.0;
/// Time of a search on two cores, divided by its number of RK4 steps, s. Measured for four vehicles
/// on a processor with AVX2: 0.9e-7 to 1.7e-7.
constexpr double kTimeOfStep_s = 1e-7;
/// Typical numbers of evaluations, to estimate the duration: kOnAllDraws in the last part of the
/// search (on all drawn vehicles), kOnNewDraws after the search (on newly drawn vehicles).
constexpr double kOnAllDraws = 12.0;
constexpr double kOnNewDraws = 3.0;

/// Calls `options.notice` if the search takes long. `steps`: RK4 steps of all runs on one vehicle;
/// `modes`: number of modes.
void announce(const TuneOptions& options, double steps, int modes) {
  double runs = static_cast<double>(options.global_evaluations) + options.local_evaluations;
  if (!options.nominal) {
    runs *= 1.0 + std::min(options.draws, kSearchedDraws * 3 / modes);
    runs += kOnAllDraws * (1.0 + options.draws) + kOnNewDraws * options.evaluation_draws;
  }
  const double time_s = runs * steps * kTimeOfStep_s;
  if (!options.notice || time_s < kLongSearch_s) return;
  options.notice(fmt::format(
      "the search for gains takes about {:.0f} s on two cores: {:.2g} integration steps", time_s,
      runs * steps));
}

/// Error (input) if all evaluations together take more than 1e11 RK4 steps (some hours). Calls
/// TuneOptions::notice if the search takes more than about 10 s.
Status check_search_work(const TuneOptions& options, const std::vector<Scenario>& scenarios,
                         const Plant<double>& plant, const Model& model) {
  const double sample_time_s = model.vehicle.sample_time_s;
  double steps = 0.0;  // RK4 steps of one evaluation
  for (const Scenario& scenario : scenarios) {
    AWMR_RETURN_IF_ERROR(check_work(plant, model.file, scenario, sample_time_s));
    steps += static_cast<double>(tuned_modes(model.vehicle, options.mode).size()) *
             steps_of_run(plant, scenario, sample_time_s);
  }
  const double on_one_vehicle = steps;
  double evaluations = static_cast<double>(options.global_evaluations) + options.local_evaluations;
  if (!options.nominal) {
    steps *= 1.0 + options.draws;
    // After the search, about three sets of gains are evaluated on new vehicles (candidates_of()).
    evaluations += 3.0 * options.evaluation_draws / (1.0 + options.draws);
  }
  if (evaluations * steps <= kMaxSearchSteps) {
    const std::size_t modes = tuned_modes(model.vehicle, options.mode).size();
    announce(options, on_one_vehicle, static_cast<int>(modes));
    return {};
  }
  return input_error(
      ErrorCode::kTooLarge, "",
      fmt::format(
          "{:g} evaluations of {:.3g} RK4 steps each ({} scenarios in every mode) exceed "
          "the limit of {:g} steps; reduce global_evaluations and local_evaluations to {:.0f} "
          "together, or shorten the scenarios",
          evaluations, steps, scenarios.size(), kMaxSearchSteps,
          std::floor(kMaxSearchSteps / steps)));
}

/// The problem of a search in these scenarios, for all modes or for TuneOptions::mode. Fills in
/// default limits of the observer in `options`.
Result<TuningProblem> problem_of(const Model& model, const DrawnVehicle& nominal,
                                 std::vector<Scenario> scenarios, TuneOptions& options) {
  AWMR_ASSIGN_OR_RETURN(const BatchArithmetic arithmetic, batch_arithmetic());
  TuningProblem problem{.setting = {.vehicles = {nominal},
                                    .vehicle = model.vehicle,
                                    .weights = options.weights,
                                    .scenarios = std::move(scenarios),
                                    .tail_share = options.tail_share,
                                    .seed = options.seed,
                                    .arithmetic = arithmetic},
                        .context = {},
                        .robust = {}};
  problem.context = context_of(options, nominal.plant, model.vehicle, problem.setting.scenarios);
  AWMR_RETURN_IF_ERROR(limit_observer(problem.context, options.observer));
  if (!options.nominal) AWMR_RETURN_IF_ERROR(add_draws(model, options, problem));
  return problem;
}

/// Time of the scenarios in a search for one mode alone, as a share of that in a search for all
/// modes (TuneOptions::has_default_scenarios).
Result<double> time_share(const Model& model, const TuneOptions& options, YawMode mode) {
  if (!options.has_default_scenarios) return 1.0;
  AWMR_ASSIGN_OR_RETURN(const Scenario all, default_tuning_scenario(model));
  AWMR_ASSIGN_OR_RETURN(const Scenario alone, default_tuning_scenario(model, mode));
  return alone.duration_s / all.duration_s;
}

/// Inputs of the searches for one mode alone.
struct ModeSearches {
  const Model& model;
  const TuningProblem& problem;  ///< of the search for all modes
  const TuneOptions& options;
  /// `options` with an observer, if the gains for all modes have one: without it, a single mode
  /// would not reject constant disturbances.
  TuneOptions observed;

  /// The problem of a search for one mode.
  Result<TuningProblem> problem_in(YawMode mode) const {
    TuningProblem of_mode = problem;
    AWMR_ASSIGN_OR_RETURN(const double share, time_share(model, options, mode));
    of_mode.setting = with_times_scaled(std::move(of_mode.setting), share);
    return of_mode;
  }

  /// Tunes for one mode. If runs do not settle with the observer, because it makes the commands
  /// noisier, and an observer was not requested, also tunes without it, and returns the result
  /// without it if the share of settled runs is larger by at least kWorthIt.
  Result<Tuning> search(YawMode mode) const {
    AWMR_ASSIGN_OR_RETURN(const TuningProblem of_mode, problem_in(mode));
    AWMR_ASSIGN_OR_RETURN(const Scenario held_out, held_out_scenario(model, mode));
    Result<Tuning> tuning = tune_for(mode, model, of_mode, observed, held_out);
    if (options.observer || !observed.observer) return tuning;
    const ObjectiveSetting runs = runs_in(of_mode.setting, {}, mode);
    const double share = tuning ? settled_share(runs, tuning->gains) : 0.0;
    if (share >= kSettledShare) return tuning;
    TuneOptions without = options;
    without.adds_observer = false;
    Result<Tuning> other = tune_for(mode, model, of_mode, without, held_out);
    const bool is_worth_it = other && settled_share(runs, other->gains) >= share + kWorthIt;
    return is_worth_it ? std::move(other) : std::move(tuning);
  }
};

/// Tunes for each mode alone and returns the gains by mode. If no mode gets gains of its own,
/// returns `common`, the result of tuning for all modes together.
Result<Tuning> tune_by_mode(const Model& model, const TuningProblem& problem,
                            const TuneOptions& options, const Scenario& held_out, Tuning common) {
  if (options.notice) {
    options.notice(
        "a mode may settle much faster with its own gains, so gains are also searched for each "
        "mode, which takes one to three times as long as the first search");
  }
  ModeSearches searches{model, problem, options, options};
  if (common.gains.observer.is_on() && !options.observer) {
    searches.observed.observer.emplace();
    AWMR_RETURN_IF_ERROR(limit_observer(problem.context, searches.observed.observer));
  }
  const ModeTuning steps{
      .setting = [&](YawMode mode) -> Result<ObjectiveSetting> {
        AWMR_ASSIGN_OR_RETURN(TuningProblem of_mode, searches.problem_in(mode));
        return std::move(of_mode.setting);
      },
      .search = [&](YawMode mode) { return searches.search(mode); },
      .compare_with_baseline =
          [&](Tuning& tuning) { return compare_with_baseline(model, problem, options, tuning); }};
  AWMR_ASSIGN_OR_RETURN(std::optional<Tuning> own,
                        with_own_gains(problem.setting, held_out, common, options.baseline, steps));
  return own ? *std::move(own) : std::move(common);
}

}  // namespace

void choose_observer(std::optional<bool> observer, TuneOptions& options) {
  if (observer == true && !options.observer) options.observer.emplace();
  if (observer == false) {
    options.observer.reset();
    options.adds_observer = false;
  }
}

ModeGains Tuning::mode_gains() const {
  ModeGains all(gains);
  for (const Tuning& one : own) all.set(*one.mode, one.gains);
  return all;
}

Result<Tuning> tune(const Model& model, const TuneOptions& requested) {
  TuneOptions options = requested;
  AWMR_RETURN_IF_ERROR(check_options(options, model.vehicle));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  AWMR_ASSIGN_OR_RETURN(const Scenario held_out, held_out_scenario(model, options.mode));
  std::vector<Scenario> scenarios = options.scenarios;
  if (scenarios.empty()) {
    options.has_default_scenarios = true;
    AWMR_ASSIGN_OR_RETURN(scenarios, default_tuning_scenarios(model, options));
  }
  const DrawnVehicle nominal{plant, model.vehicle.wheel_force};
  AWMR_RETURN_IF_ERROR(
      check_turning(nominal, tuned_modes(model.vehicle, options.mode), scenarios, model.file));
  AWMR_RETURN_IF_ERROR(check_search_work(options, scenarios, plant, model));
  AWMR_ASSIGN_OR_RETURN(const TuningProblem problem,
                        problem_of(model, nominal, std::move(scenarios), options));
  AWMR_ASSIGN_OR_RETURN(Tuning common, tune_for(options.mode, model, problem, options, held_out));
  const bool may_be_faster = !common.alone.empty() || common.is_mode_better_alone;
  if (options.one_set || !may_be_faster) return common;
  return tune_by_mode(model, problem, options, held_out, std::move(common));
}

}  // namespace awmr
