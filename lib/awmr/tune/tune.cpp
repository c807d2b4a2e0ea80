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
#include "awmr/simulate/physics.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/tuning_context.h"
#include "awmr/tune/tuning_steps.h"
#include "awmr/tune/turning.h"
#include "awmr/tune/unsettled_cause.h"

namespace awmr {
namespace {

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

Result<Tuning> tune_for(std::optional<YawMode> mode, const Model& model, TuningProblem problem,
                        TuneOptions options, const Scenario& held_out) {
  auto& [setting, context, robust] = problem;
  options.mode = setting.mode = context.mode = mode;
  if (robust) limit_steering_rate(context);
  AWMR_ASSIGN_OR_RETURN(Tuning tuning, search_gains(model, setting, context, options, held_out));
  tuning.mode = mode;
  if (robust) {
    tuning.robust = std::move(robust);
    AWMR_RETURN_IF_ERROR(evaluate_on_new_vehicles(model, setting, options, tuning));
  }
  tuning.unsettled = unsettled_runs(tuning, setting, context, options);
  return tuning;
}

namespace {

/// tune(), without the check that runs settle with the gains.
Result<Tuning> tuned(const Model& model, TuneOptions options) {
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
  if (options.notice) {
    options.notice(
        "a mode may settle much faster with its own gains, so gains are also searched for each "
        "mode, which takes one to three times as long as the first search");
  }
  return tune_by_mode(model, problem, options, held_out, std::move(common));
}

}  // namespace

Result<Tuning> tune(const Model& model, const TuneOptions& options) {
  AWMR_ASSIGN_OR_RETURN(Tuning tuning, tuned(model, options));
  AWMR_RETURN_IF_ERROR(check_settled(tuning, options));
  return tuning;
}

}  // namespace awmr
