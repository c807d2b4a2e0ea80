#include "awmr/tune/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <variant>

#include "awmr/control/controller.h"
#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/model/paper_gains.h"
#include "awmr/model/steady.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/certificate.h"
#include "awmr/tune/check_options.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/pole_placement.h"
#include "awmr/tune/refusals.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/search.h"
#include "awmr/tune/sensitivity.h"
#include "awmr/tune/settling.h"
#include "awmr/tune/steering_rate.h"
#include "awmr/tune/trade_off.h"
#include "awmr/tune/turning.h"

namespace awmr {
namespace {

/// Largest number of RK4 steps of a search. They take some hours.
constexpr double kMaxSearchSteps = 1e11;

/// A search that is expected to take longer on two cores, s, is announced.
constexpr double kLongSearch_s = 10.0;
/// Time of an RK4 step on two cores, s.
constexpr double kTimeOfStep_s = 2.5e-8;
/// For the estimated duration: number of evaluations on all draws in the last part of the search,
/// and number of evaluations of gains on new draws.
constexpr double kOnAllDraws = 12.0;
constexpr double kOnNewDraws = 3.0;

/// Reports a long search. `steps`: RK4 steps of all runs on one vehicle; `modes`: number of modes.
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

/// Error (input) if all evaluations together take more than kMaxSearchSteps.
Status check_work(const TuneOptions& options, const std::vector<Scenario>& scenarios,
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
    // The evaluation runs about three sets of gains (candidates_of()) on each draw.
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

/// The largest change of the commanded heading, rad.
double largest_step_rad(const Scenario& scenario) {
  double largest = 0.0;
  double before = scenario.initial.psi_rad;
  for (const HeadingStep& step : std::get<HeadingSteps>(scenario.guidance).steps) {
    largest = std::max(largest, std::abs(wrap_angle(step.psi_rad - before)));
    before = step.psi_rad;
  }
  return largest;
}

/// Expected highest yaw rate in runs of the scenario, rad/s: the largest heading step divided by 1
/// s, or the heading-rate limit if that is lower.
double reached_radps(const Scenario& scenario) {
  const double in_a_second = largest_step_rad(scenario) / 1.0;
  return scenario.shaping ? std::min(in_a_second, scenario.shaping->rate_max_radps) : in_a_second;
}

ConstraintContext context_of(const TuneOptions& options, const Plant<double>& plant,
                             const Vehicle& vehicle, const std::vector<Scenario>& scenarios) {
  ConstraintContext context{.form = options.form,
                            .margin = options.margin,
                            .plant = plant,
                            .has_steering = vehicle.has_steering(),
                            .mode = options.mode,
                            .sample_time_s = vehicle.sample_time_s,
                            .speed_mps = 0.0,
                            .step_rad = 0.0,
                            .fastest_radps = kSlowest_radps,
                            .limits = options.limits,
                            .wheel_force = vehicle.wheel_force};
  for (const Scenario& s : scenarios) {
    context.speed_mps = std::max(context.speed_mps, s.speed_mps);
    context.step_rad = std::max(context.step_rad, largest_step_rad(s));
    context.fastest_radps = std::max(context.fastest_radps, reached_radps(s));
  }
  // The expected yaw rate is at most that of the steady turn at the largest moment of the stronger
  // mode.
  const auto steady = steady_rate(plant.yaw, largest_moment_m(context.own(), context.speed_mps));
  if (steady) context.fastest_radps = std::clamp(*steady, kSlowest_radps, context.fastest_radps);
  return context;
}

/// Sets the limit of the steering rate to its default, if it is absent (TuningLimits).
void limit_steering_rate(const Vehicle& vehicle, ConstraintContext& context) {
  if (context.limits.steering_rate_rms_degps || !context.steers()) return;
  constexpr double kShareOfServo = 0.9;
  constexpr double kOverFeedForward = 1.25;
  const double servo_degps =
      std::min(vehicle.steering_max_rate_degps, 2.0 * degrees(context.plant.steering_max_rad) /
                                                    context.plant.steering_time_constant_s);
  const Gains<double> none{{0.0, 0.0, 1.0}, {0.0, 1.0}};
  // The default is computed without Coulomb friction: with_friction_width() keeps the noise that
  // friction adds within the limit.
  ConstraintContext without_friction = context;
  without_friction.plant.yaw.coulomb = 0.0;
  context.limits.steering_rate_rms_degps =
      std::max(kShareOfServo * servo_degps,
               kOverFeedForward * steering_rate_rms_degps(none, without_friction));
}

/// Sets the default limits of an observer. Errors (input): no force remains to compensate with.
Status limit_observer(const ConstraintContext& context, std::optional<ObserverSearch>& observer) {
  if (!observer) return {};
  const Plant<double>& plant = context.plant;
  const double left = driven_wheels(plant) * forces_beyond_dead_zone(context.own()).hi -
                      plant.surge(context.speed_mps);
  const std::tuple<const char*, std::optional<double>*, double> limits[] = {
      {"yaw_max_m", &observer->yaw_max_m, turning_authority_m(context.own(), context.speed_mps)},
      {"surge_max", &observer->surge_max, left}};
  for (const auto& [name, limit, most] : limits) {
    if (!*limit) *limit = kObserverShare * most;
    if (**limit > 0.0) continue;
    return input_error(ErrorCode::kOutOfRange, "",
                       fmt::format("no default for the observer's {}: at {:g} m/s the wheels have "
                                   "no force left to compensate a disturbance; give slower "
                                   "scenarios",
                                   name, context.speed_mps));
  }
  return {};
}

/// The setting with the nominal vehicle and the first draws, for the search.
ObjectiveSetting searched(ObjectiveSetting setting, const TuneOptions& options) {
  const std::size_t as_many_runs =
      at(kSearchedDraws) * std::size(kYawModes) / setting.modes().size();
  const std::size_t draws = std::max(as_many_runs, options.open.combinations());
  if (setting.vehicles.size() > 1 + draws) setting.vehicles.resize(1 + draws);
  return setting;
}

Status check_baseline(const Objective& objective, const Baseline& baseline) {
  if (objective.baseline().valid) return {};
  return input_error(ErrorCode::kDiverges, baseline.source,
                     "runs with the baseline gains diverge, so the objective cannot be normalised; "
                     "give another baseline, or slower scenarios");
}

/// Factors of slowed(), for starts with slower poles, which meet the noise limits if the noise is
/// large.
constexpr double kSlowerStarts[] = {0.7, 0.5, 0.35, 0.25};

/// Bandwidths of the observer at starts of the search, rad/s.
constexpr double kStartBandwidths[] = {0.5, 1.0, 2.0};

/// Starts of the search: `first`, which meets the constraints; the second of `poles`; the first of
/// `poles` slowed down by each of kSlowerStarts; if an observer is searched, poles placed with each
/// of kStartBandwidths; the baseline, if given. Each start but `first` is replaced by gains that
/// meet the constraints (feasible_start()), or left out if there are none.
std::vector<Gains<double>> starts_of(const TuneOptions& options, const ConstraintContext& context,
                                     const Gains<double>& first,
                                     std::span<const Gains<double>> poles) {
  std::vector<Gains<double>> starts{first};
  const auto add = [&](const Gains<double>& gains) {
    const Candidate other = feasible_start(options, context, gains);
    if (!(other.violation > 0.0)) starts.push_back(other.gains);
  };
  for (const Gains<double>& other : poles.subspan(1)) add(other);
  for (const double share : kSlowerStarts) add(slowed(poles.front(), share));
  if (const auto& observer = options.observer) {
    for (const double bandwidth_radps : kStartBandwidths) {
      if (!observer->bandwidth_radps.contains(bandwidth_radps)) continue;
      add(starting_poles(context,
                         {bandwidth_radps, *observer->yaw_max_m, *observer->surge_max})[0]);
    }
  }
  if (options.baseline) add(options.baseline->gains);
  return starts;
}

Result<Tuning> search_gains(const Model& model, const ObjectiveSetting& setting,
                            const ConstraintContext& context, const TuneOptions& requested,
                            const Scenario& held_out);

/// Repeats the search with an observer. Empty if no observer may be added
/// (TuneOptions::adds_observer), if the runs with `gains` do not need one to settle
/// (needs_observer()), or if the result does not increase least_settled_share() by kWorthIt.
std::optional<Tuning> with_needed_observer(const Model& model, const ObjectiveSetting& setting,
                                           const ConstraintContext& context,
                                           const TuneOptions& requested, const Scenario& held_out,
                                           const Gains<double>& gains) {
  const bool has_observer =
      requested.observer || std::ranges::any_of(setting.scenarios, [](const Scenario& scenario) {
        return scenario.control.observer.has_value();
      });
  if (has_observer || !requested.adds_observer) return std::nullopt;
  if (!needs_observer(setting, context, gains)) return std::nullopt;
  TuneOptions options = requested;
  options.observer.emplace();
  if (!limit_observer(context, options.observer)) return std::nullopt;
  if (options.notice) {
    options.notice(
        "some runs settle only with a disturbance observer, so the search is repeated with one");
  }
  Result<Tuning> observed = search_gains(model, setting, context, options, held_out);
  constexpr double kWorthIt = 1.0 - kSettledShare;
  if (!observed || least_settled_share(setting, observed->gains) <
                       least_settled_share(setting, gains) + kWorthIt) {
    return std::nullopt;
  }
  observed->observer_added = true;
  return *std::move(observed);
}

/// Searches the gains on one setting, and evaluates them also in the scenario `held_out`. If runs
/// need an observer to settle (TuneOptions::adds_observer), searches again with one.
Result<Tuning> search_gains(const Model& model, const ObjectiveSetting& setting,
                            const ConstraintContext& context, const TuneOptions& requested,
                            const Scenario& held_out) {
  const std::array<Gains<double>, 2> poles = starting_poles(context);
  TuneOptions options = requested;
  bound_around(poles, options.bounds);
  const Candidate first = feasible_start(options, context, poles[0]);
  if (first.violation > 0.0) return infeasible(first, context, requested);
  const std::vector<Gains<double>> starts = starts_of(options, context, first.gains, poles);
  const Baseline baseline = options.baseline.value_or(Baseline{poles[1], kPolePlacement});
  const Objective all(setting, baseline.gains);
  AWMR_RETURN_IF_ERROR(check_baseline(all, baseline));
  const Objective some(searched(setting, options), baseline.gains);
  AWMR_ASSIGN_OR_RETURN(const SearchResult found, search(options, context, some, all, starts));
  if (!found.best) return not_found(found, all, requested);
  const SettledGains settled = settle(options, context, some, all, *found.best);
  if (auto observed =
          with_needed_observer(model, setting, context, requested, held_out, settled.gains)) {
    return *std::move(observed);
  }
  AWMR_ASSIGN_OR_RETURN(std::vector<ActiveConstraint> active,
                        active_constraints(options, context, some, *found.best));
  const Evaluation tuned = all(settled.gains);
  const auto settles = [](const ModeScore& score) { return score.metrics.completed; };
  if (std::ranges::none_of(tuned.scores, settles)) {
    ObjectiveSetting nominal = setting;
    nominal.vehicles.resize(1);
    constexpr double kAny = 1e-9;
    return never_settles(settled.gains, tuned.scores.size(),
                         changes_that_settle(nominal, context, settled.gains, kAny), requested);
  }
  AWMR_ASSIGN_OR_RETURN(Certificate certificate,
                        certify(model, context, options.open, settled.gains));
  TradeOff trade_off = trade_off_of(some, context, found.met, settled.gains, baseline.gains);
  ObjectiveSetting elsewhere = setting;
  elsewhere.scenarios = {held_out};
  elsewhere.goals.clear();
  const Evaluation evaluated = Objective(std::move(elsewhere), baseline.gains)(settled.gains);

  return Tuning{.gains = settled.gains,
                .constraints = constraints_of(settled.gains, context),
                .objective = tuned.objective,
                .scores = tuned.scores,
                .baseline = baseline,
                .limits = context.limits,
                .examined = {context.speed_mps, context.step_rad, context.fastest_radps},
                .baseline_objective = all.baseline().objective,
                .baseline_scores = all.baseline().scores,
                .algorithm = found.algorithm,
                .evaluations = found.evaluations,
                .stop_reason = found.stop_reason,
                .seed = options.seed,
                .simulated = found.simulated,
                .mu_as_good = settled.mu,
                .speed_mu_as_good = settled.speed_mu,
                .active = std::move(active),
                .arithmetic = std::string(setting.arithmetic.rounding),
                .history = found.history,
                .held_out_scores = evaluated.scores,
                .held_out_objective = evaluated.objective,
                .certificate = std::move(certificate),
                .trade_off = std::move(trade_off),
                .observer_added = false,
                .unsettled = {},
                .robust = {}};
}

/// The runs of each scenario and mode with few settled runs, and the changes with which they settle
/// on the nominal vehicle and the first draws of the setting.
std::vector<UnsettledRuns> unsettled_runs(const Tuning& tuning, const ObjectiveSetting& setting,
                                          const ConstraintContext& context) {
  std::vector<UnsettledRuns> all;
  const auto look_at = [&](const std::string& scenario, YawMode mode, double settled_share) {
    if (settled_share >= kSettledShare) return;
    const ObjectiveSetting runs = on_few_vehicles(runs_in(setting, scenario, mode));
    const Status turns =
        check_turning(context.own(), std::span(&mode, 1), runs.scenarios, std::string());
    UnsettledRuns unsettled{.scenario = scenario, .mode = mode, .why = {}, .changes = {}};
    if (turns) {
      unsettled.changes = changes_that_settle(runs, context, tuning.gains, kSettledShare);
    } else {
      unsettled.why = turns.error().faults.front().message;
    }
    all.push_back(std::move(unsettled));
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
      fmt::format("{:g} s are {:.4g} samples of {:g} s, more than the limit of {} samples; give a "
                  "longer sample_time_s, or tune without latency, noise and lag ({})",
                  context.latency_s, samples, context.sample_time_s, kMaxLatencySamples,
                  option_text("nominal")));
}

/// Number that is XORed with the seed, so that the evaluation uses other draws than the search.
constexpr std::uint64_t kEvaluationSeeds = 0x6a75646765ULL;

/// Sets of gains to evaluate: tuned, baseline, the paper's, and the tuned ones without their
/// observer.
std::vector<NamedCandidate> candidates_of(const Tuning& tuning) {
  std::vector<NamedCandidate> candidates{{kRobustGains, tuning.gains},
                                         {"baseline", tuning.baseline.gains}};
  if (tuning.baseline.source != kPaperSource) candidates.push_back({"paper", kPaperGains});
  if (tuning.gains.observer.is_on()) {
    Gains<double> unobserved = tuning.gains;
    unobserved.observer = {};
    candidates.push_back({"unobserved", unobserved});
  }
  return candidates;
}

/// Runs the candidates on new draws and adds the statistics to `robust`.
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

/// Tunes robust gains: adds draws, noise, latency and motor lag to the `setting` and `context` of
/// the nominal search.
Result<Tuning> tune_robustly(const Model& model, ObjectiveSetting setting,
                             ConstraintContext context, const TuneOptions& options,
                             const Scenario& held_out) {
  RobustTuning robust{.conditions = conditions_of(model.vehicle),
                      .from_covariance = !model.covariance.parameters.empty(),
                      .evaluated = {},
                      .evaluated_by_scenario = {},
                      .goals = {}};
  const LoopConditions& c = robust.conditions;
  AWMR_ASSIGN_OR_RETURN(setting.vehicles, vehicles_of(model, options.draws, options.seed,
                                                      options.open, Spread::kEven));
  for (Scenario& scenario : setting.scenarios) scenario = under(c, std::move(scenario));
  setting.goals = options.goals;
  context.draws.assign(setting.vehicles.begin() + 1, setting.vehicles.end());
  context.heading_noise_rad = radians(c.heading_noise_deg);
  context.yaw_rate_noise_radps = radians(c.yaw_rate_noise_degps);
  context.heading_correlation = noise_correlation(c.heading_correlation_s, context.sample_time_s);
  context.yaw_rate_correlation = noise_correlation(c.yaw_rate_correlation_s, context.sample_time_s);
  context.latency_s = std::max(c.heading_latency_s, c.yaw_rate_latency_s);
  context.motor_time_constant_s = c.motor_time_constant_s;
  limit_steering_rate(model.vehicle, context);
  AWMR_RETURN_IF_ERROR(check_latency(context, model.file));
  AWMR_ASSIGN_OR_RETURN(Tuning tuning, search_gains(model, setting, context, options, held_out));
  AWMR_RETURN_IF_ERROR(evaluate_candidates(model, setting, options, candidates_of(tuning), robust));
  tuning.robust = std::move(robust);
  tuning.unsettled = unsettled_runs(tuning, setting, context);
  return tuning;
}

}  // namespace

Result<Tuning> tune(const Model& model, const TuneOptions& requested) {
  TuneOptions options = requested;
  AWMR_RETURN_IF_ERROR(check_options(options, model.vehicle));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  AWMR_ASSIGN_OR_RETURN(const BatchArithmetic arithmetic, batch_arithmetic());
  AWMR_ASSIGN_OR_RETURN(const Scenario held_out, held_out_scenario(model));
  std::vector<Scenario> scenarios = options.scenarios;
  if (scenarios.empty()) {
    AWMR_ASSIGN_OR_RETURN(scenarios, default_tuning_scenarios(model, options));
  }
  const DrawnVehicle nominal{plant, model.vehicle.wheel_force};
  AWMR_RETURN_IF_ERROR(
      check_turning(nominal, tuned_modes(model.vehicle, options.mode), scenarios, model.file));
  AWMR_RETURN_IF_ERROR(check_work(options, scenarios, plant, model));
  ObjectiveSetting setting{.vehicles = {nominal},
                           .vehicle = model.vehicle,
                           .weights = options.weights,
                           .scenarios = std::move(scenarios),
                           .tail_share = options.tail_share,
                           .seed = options.seed,
                           .arithmetic = arithmetic,
                           .mode = options.mode};
  ConstraintContext context = context_of(options, plant, model.vehicle, setting.scenarios);
  AWMR_RETURN_IF_ERROR(limit_observer(context, options.observer));
  if (options.nominal) {
    AWMR_ASSIGN_OR_RETURN(Tuning tuning, search_gains(model, setting, context, options, held_out));
    tuning.unsettled = unsettled_runs(tuning, setting, context);
    return tuning;
  }
  return tune_robustly(model, std::move(setting), std::move(context), options, held_out);
}

}  // namespace awmr
