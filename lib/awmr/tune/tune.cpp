#include "awmr/tune/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>
#include <variant>

#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/model/fitted_law.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/scenario.h"
#include "awmr/simulate/simulate.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/global_sensitivity.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/search.h"
#include "awmr/tune/sensitivity.h"

namespace awmr {
namespace {

void check_bounds(const Interval& range, const char* name, std::vector<Fault>& faults) {
  if (range.lo > 0.0 && range.lo <= range.hi && std::isfinite(range.hi)) return;
  faults.push_back({"", fmt::format("bounds of {}: [{}, {}], but 0 < lo <= hi is needed", name,
                                    range.lo, range.hi)});
}

void check_observer(const std::optional<ObserverSearch>& observer, std::vector<Fault>& faults) {
  if (!observer) return;
  check_bounds(observer->bandwidth_radps, "the observer's bandwidth_radps", faults);
  for (const auto& [name, limit] :
       {std::pair("yaw_max_m", observer->yaw_max_m), std::pair("surge_max", observer->surge_max)}) {
    if (!limit || (*limit > 0.0 && std::isfinite(*limit))) continue;
    faults.push_back({"", fmt::format("the observer's {}: {} is not above 0", name, *limit)});
  }
}

void check_weights(const ObjectiveWeights& w, std::vector<Fault>& faults) {
  const double values[] = {w.itae, w.overshoot, w.control_variation, w.effort, w.speed_itae};
  double sum = 0.0;
  for (const double value : values) {
    if (!(value >= 0.0)) faults.push_back({"", fmt::format("weights: {} is below 0", value)});
    sum += value;
  }
  if (!(sum > 0.0) || !std::isfinite(sum)) {
    faults.push_back({"", "weights: at least one has to be above 0, and all finite"});
  }
}

void check_scenarios(const std::vector<Scenario>& scenarios, bool observer_is_searched,
                     std::vector<Fault>& faults) {
  std::set<std::string> names;
  for (const Scenario& scenario : scenarios) {
    if (!std::holds_alternative<HeadingSteps>(scenario.guidance)) {
      faults.push_back({"", fmt::format("scenario '{}' commands no headings; gains are tuned on "
                                        "guidance of type 'heading'",
                                        scenario.name)});
    }
    if (scenario.control.lqi) {
      faults.push_back({"", fmt::format("scenario '{}' names the heading law lqi, which takes no "
                                        "gains; those of the sliding mode are tuned",
                                        scenario.name)});
    }
    if (observer_is_searched && scenario.control.observer) {
      faults.push_back(
          {"", fmt::format("scenario '{}' has a disturbance_observer of its own, and one "
                           "is to be tuned: leave out one of them",
                           scenario.name)});
    }
    if (!names.insert(scenario.name).second) {
      faults.push_back({"", fmt::format("two scenarios are named '{}'; scores are told apart by "
                                        "name, so give each its own",
                                        scenario.name)});
    }
  }
}

void check_robustness(const TuneOptions& options, std::vector<Fault>& faults) {
  if (options.draws < 0 || options.draws > 1000) {
    faults.push_back({"", fmt::format("draws: {} is not in 0 ... 1000", options.draws)});
  }
  if (options.judged_draws < 0 || options.judged_draws > 100000) {
    faults.push_back(
        {"", fmt::format("judged_draws: {} is not in 0 ... 100000", options.judged_draws)});
  }
  if (!(options.tail_share > 0.0 && options.tail_share <= 1.0)) {
    faults.push_back({"", fmt::format("tail_share: {} is not in (0, 1]", options.tail_share)});
  }
  if (!(options.activity_max > 0.0) || !std::isfinite(options.activity_max)) {
    faults.push_back({"", fmt::format("activity_max: {} is not above 0", options.activity_max)});
  }
}

void check_open(const TuneOptions& options, std::vector<Fault>& faults) {
  const OpenVehicle& open = options.open;
  if (!open.any()) return;
  if (options.nominal) {
    faults.push_back({"",
                      "what is open is taken by the draws, and a nominal search draws nothing: "
                      "leave out nominal, or open"});
    return;
  }
  for (const double factor : open.mass_factors) {
    if (factor >= kLeastMassFactor && factor <= kMostMassFactor) continue;
    faults.push_back({"", fmt::format("open: a mass factor of {} is not in {} ... {}", factor,
                                      kLeastMassFactor, kMostMassFactor)});
  }
  for (const Interval& force : open.wheel_forces) {
    if (force.lo >= -1.0 && force.lo < force.hi && force.hi > 0.0 && force.hi <= 1.0) continue;
    faults.push_back({"", fmt::format("open: wheel forces of [{}, {}], but -1 <= min < max and 0 < "
                                      "max <= 1 is needed",
                                      force.lo, force.hi)});
  }
  if (std::max(open.mass_factors.size(), open.wheel_forces.size()) > kMostOpenValues) {
    faults.push_back({"", fmt::format("open: more than {} values of a kind", kMostOpenValues)});
  }
  const auto fewest = static_cast<int>(open.combinations());
  for (const auto& [name, count] :
       {std::pair("draws", options.draws), std::pair("judged_draws", options.judged_draws)}) {
    if (count >= fewest || (count == 0 && name == std::string_view("judged_draws"))) continue;
    faults.push_back({"", fmt::format("{}: {} do not take all of the {} combinations of what is "
                                      "open; give a multiple of {}",
                                      name, count, fewest, fewest)});
  }
}

void check_part(const TuneOptions& options, std::vector<Fault>& faults) {
  if (!options.shard) return;
  if (options.nominal) {
    faults.push_back(
        {option_text("shard"),
         "nominal gains are judged on no draws, which parts could share: leave out one "
         "of them"});
  }
  if (auto fault =
          shard_fault(*options.shard, options.judged_draws, "fresh draws (judged_draws)")) {
    faults.push_back(std::move(*fault));
  }
}

void check_goal(const TuningGoal& goal, std::vector<Fault>& faults) {
  std::set<std::string> figures;
  for (const auto& [figure, most] : goal.at_most) {
    if (!is_run_figure(figure) || !figures.insert(figure).second) {
      faults.push_back({"", fmt::format("goals: {} is no figure, or there twice; there are {}",
                                        figure, fmt::join(run_figure_names(), ", "))});
    }
    if (!(most > 0.0) || !std::isfinite(most)) {
      faults.push_back({"", fmt::format("goals: {} at most {} is not above 0", figure, most)});
    }
  }
  if (figures.empty()) faults.push_back({"", "goals: one without a limit"});
  if (!(goal.share >= kLeastShare && goal.share <= kMostShare)) {
    faults.push_back({"", fmt::format("goals: a share of {} is not in {} ... {}", goal.share,
                                      kLeastShare, kMostShare)});
  }
}

void check_sensitivity(const TuneOptions& options, std::vector<Fault>& faults) {
  if (options.sensitivity == 0) return;
  if (options.sensitivity < kFewestSamples || options.sensitivity > kMostSamples) {
    faults.push_back({"", fmt::format("sensitivity: {} is neither 0 nor in {} ... {}",
                                      options.sensitivity, kFewestSamples, kMostSamples)});
  }
  if (options.nominal) {
    faults.push_back({"",
                      "sensitivity is to what a nominal search does not assume: leave out one "
                      "of them"});
  }
}

void check_goals(const TuneOptions& options, const Vehicle& vehicle, std::vector<Fault>& faults) {
  if (options.goals.empty()) return;
  const std::span<const YawMode> modes = yaw_modes(vehicle);
  for (const TuningGoal& goal : options.goals) {
    if (goal.mode && std::ranges::find(modes, *goal.mode) == modes.end()) {
      faults.push_back({"", fmt::format("goals: a vehicle of drive \"{}\" has no mode {}",
                                        name_in(kDriveNames, vehicle.drive), name_of(*goal.mode))});
    }
  }
  if (options.nominal) {
    faults.push_back({"",
                      "goals are chances over what is drawn, and a nominal search draws "
                      "nothing: leave out nominal, or the goals"});
  }
  if (options.judged_draws == 0) {
    faults.push_back({"", "goals are judged on fresh draws: judged_draws has to be above 0"});
  }
  if (options.goals.size() > kMostGoals) {
    faults.push_back(
        {"", fmt::format("goals: {} are more than {}", options.goals.size(), kMostGoals)});
  }
  for (const TuningGoal& goal : options.goals) check_goal(goal, faults);
}

Status check(const TuneOptions& options, const Vehicle& vehicle) {
  std::vector<Fault> faults;
  check_goals(options, vehicle, faults);
  check_sensitivity(options, faults);
  if (!(options.margin > 0.0 && options.margin < 1.0)) {
    faults.push_back({"", fmt::format("margin: {} is not in (0, 1)", options.margin)});
  }
  if (options.global_evaluations < 1 || options.local_evaluations < 0) {
    faults.push_back({"", "evaluations: global at least 1, local at least 0"});
  }
  check_robustness(options, faults);
  check_open(options, faults);
  check_part(options, faults);
  check_weights(options.weights, faults);
  check_bounds(options.bounds.lambda, "lambda", faults);
  check_bounds(options.bounds.mu, "mu", faults);
  check_bounds(options.bounds.epsilon, "epsilon", faults);
  check_bounds(options.bounds.speed_mu, "speed_mu", faults);
  check_bounds(options.bounds.speed_epsilon, "speed_epsilon", faults);
  check_observer(options.observer, faults);
  check_scenarios(options.scenarios, options.observer.has_value(), faults);
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

/// Behind the name of a default scenario whose heading is led.
constexpr std::string_view kLedSuffix = "_led";

/// RK4 steps of a search at the most: some hours.
constexpr double kMostSearchSteps = 1e11;

/// Each run's work is bounded, and so is that of all evaluations together.
Status check_work(const TuneOptions& options, const std::vector<Scenario>& scenarios,
                  const Plant<double>& plant, const Model& model) {
  const double sample_time_s = model.vehicle.sample_time_s;
  double steps = 0.0;  // of one evaluation
  for (const Scenario& scenario : scenarios) {
    AWMR_RETURN_IF_ERROR(check_work(plant, model.file, scenario, sample_time_s));
    steps += static_cast<double>(yaw_modes(model.vehicle).size()) *
             steps_of_run(plant, scenario, sample_time_s);
  }
  double evaluations = static_cast<double>(options.global_evaluations) + options.local_evaluations;
  if (!options.nominal) {
    steps *= 1.0 + options.draws;
    // Three sets of gains are judged, each draw once.
    evaluations += (3.0 * options.judged_draws + sensitivity_runs(model, options.sensitivity)) /
                   (1.0 + options.draws);
  }
  if (evaluations * steps <= kMostSearchSteps) return {};
  return input_error(
      "", fmt::format("evaluations: {:g} of {:.3g} RK4 steps each ({} scenarios in every mode) are "
                      "more than the {:g} steps that a search may take: give at most {:.0f} "
                      "evaluations, global and local together, or shorter scenarios",
                      evaluations, steps, scenarios.size(), kMostSearchSteps,
                      std::floor(kMostSearchSteps / steps)));
}

std::string in_words(const Gains<double>& g) {
  return fmt::format(
      "lambda {:.4g}, mu {:.4g}, epsilon {:.4g}, mu_s {:.4g}, epsilon_s {:.4g}{}", g.heading.lambda,
      g.heading.mu, g.heading.epsilon, g.speed.mu, g.speed.epsilon,
      g.observer.is_on() ? fmt::format(", observer {:.4g} rad/s", g.observer.bandwidth_radps) : "");
}

/// What helps where a constraint leaves no gains.
std::string advice_on(std::string_view constraint) {
  if (constraint == "late damping" || constraint == "delay margin") {
    return "the readings are too late for this vehicle, nearly whatever the gains: make them "
           "sooner "
           "(latency_s of vehicle.json), or tune without latency (" +
           option_text("nominal") + ")";
  }
  if (constraint == "noise gain") {
    return "the heading's noise takes too much of what the vehicle can turn with: a calmer compass "
           "(noise of vehicle.json), a faster scenario, or wider bounds";
  }
  if (constraint == "heading damping") {
    return "samples or the servo are too slow for the yaw resistance that the law makes up for, or "
           "the model leaves it too open: a shorter sample_time_s or steering.time_constant_s, "
           "better turning trials, or wider bounds";
  }
  if (constraint == "speed lag" || constraint == "speed gain") {
    return "servo, motors or readings are too slow, or samples too long, for the speed loop that "
           "the bounds ask for: wider bounds (speed_mu, speed_epsilon)";
  }
  return "raise the margin, choose form 'paper' or widen the bounds";
}

/// No gains meet the constraints: the one broken most by the gains that come nearest.
tl::unexpected<Error> infeasible(const Candidate& nearest, const ConstraintContext& context) {
  const std::vector<ConstraintReport> all = constraints_of(nearest.gains, context);
  const ConstraintReport* worst = nullptr;
  double worst_residual = 0.0;
  for (const ConstraintReport& c : all) {
    const std::vector<double> residual = residuals({c});
    if (residual.empty() || residual.front() <= worst_residual) continue;
    worst = &c;
    worst_residual = residual.front();
  }
  const std::string name = worst ? worst->name : "none";
  return refusal(
      fmt::format("no gains within the bounds meet the constraints: the nearest ({}) "
                  "break '{}', {:.4g} against a limit of {:.4g} ({}); {}",
                  in_words(nearest.gains), name, worst ? worst->value : 0.0,
                  worst ? worst->limit : 0.0, worst ? worst->meaning : "", advice_on(name)));
}

tl::unexpected<Error> not_better(const SearchResult& found, const Objective& objective,
                                 std::span<const YawMode> modes) {
  const Evaluation e = objective(found.nearest.gains);
  std::string scores;
  for (std::size_t m = 0; m < e.mode_objective.size(); ++m) {
    scores +=
        fmt::format("{}{:.4f} {}", m == 0 ? "" : ", ", e.mode_objective[m], name_of(modes[m]));
  }
  const std::string broken =
      found.broken_by <= 0.0 ? ""
      : !e.valid
          ? ", and of their runs some break off or do not settle where the paper's do"
          : fmt::format(", and break '{}' by {:.0f} %", found.broken_most, 100.0 * found.broken_by);
  const char* activity =
      found.broken_most.starts_with("activity") ? ", more activity (activity_max)" : "";
  return refusal(fmt::format(
      "no gains keep every constraint and beat the paper's in every mode (1 is theirs): the "
      "nearest of {} ({}) score {}{}; give more evaluations{}, another seed or other weights. To "
      "go on with the paper's gains, write {{\"heading\": {{\"lambda\": {}, \"mu\": {}, "
      "\"epsilon\": "
      "{}}}, \"speed\": {{\"mu\": {}, \"epsilon\": {}}}}} to gains.json",
      found.evaluations, in_words(found.nearest.gains), scores, broken, activity,
      kPaperGains.heading.lambda, kPaperGains.heading.mu, kPaperGains.heading.epsilon,
      kPaperGains.speed.mu, kPaperGains.speed.epsilon));
}

/// The goal, if any, that keeps the nearest gains from being taken.
std::optional<tl::unexpected<Error>> goal_missed(const SearchResult& found,
                                                 const Objective& objective,
                                                 const std::vector<Scenario>& scenarios) {
  const Evaluation e = objective(found.nearest.gains);
  const std::vector<GoalInMode> goals = by_mode(objective.goals(), objective.modes());
  std::size_t worst = goals.size();
  for (std::size_t i = 0; i < goals.size(); ++i) {
    if (goals[i].goal->is_soft || e.goal_quantile[i] <= 1.0) continue;
    if (worst == goals.size() || e.goal_quantile[i] > e.goal_quantile[worst]) worst = i;
  }
  if (worst == goals.size()) return std::nullopt;
  const bool is_led = std::ranges::any_of(
      scenarios, [](const Scenario& one) { return one.name.ends_with(kLedSuffix); });
  return refusal(fmt::format(
      "no gains within the bounds reach the goal \"{}\": the nearest of {} ({}) need {:.3g} "
      "times its limits; make it soft, raise its limits, or give more evaluations{}",
      goals[worst].name(), found.evaluations, in_words(found.nearest.gains), e.goal_quantile[worst],
      is_led ? "; of the default scenarios one leads the heading no faster than was measured, "
               "which takes its time: " +
                   option_text("heading_rate_limit") + " none leaves it out"
             : ""));
}

bool beats_everywhere(const Evaluation& e) {
  return e.valid && std::all_of(e.mode_objective.begin(), e.mode_objective.end(),
                                [](double mode) { return mode < 1.0; });
}

ConstraintContext context_of(const TuneOptions& options, const Plant<double>& plant,
                             const Vehicle& vehicle, const std::vector<Scenario>& scenarios) {
  ConstraintContext context{.form = options.form,
                            .margin = options.margin,
                            .plant = plant,
                            .has_steering = vehicle.has_steering(),
                            .sample_time_s = vehicle.sample_time_s,
                            .speed_mps = 0.0,
                            .wheel_force = vehicle.wheel_force};
  for (const Scenario& s : scenarios) context.speed_mps = std::max(context.speed_mps, s.speed_mps);
  return context;
}

/// Gives an observer the limits that the user did not. Errors (input): there is nothing left to take
/// off with.
Status limit_observer(const ConstraintContext& context, std::optional<ObserverSearch>& observer) {
  if (!observer) return {};
  const Plant<double>& plant = context.plant;
  const double left =
      driven_wheels(plant) * context.wheel_force.hi - plant.surge(context.speed_mps);
  const std::tuple<const char*, std::optional<double>*, double> limits[] = {
      {"yaw_max_m", &observer->yaw_max_m, turning_authority_m(context.own(), context.speed_mps)},
      {"surge_max", &observer->surge_max, left}};
  for (const auto& [name, limit, most] : limits) {
    if (!*limit) *limit = kObserverShare * most;
    if (**limit > 0.0) continue;
    return input_error("",
                       fmt::format("the observer's {}: at {:g} m/s the wheels have no force left "
                                   "to take a disturbance off with: give slower scenarios",
                                   name, context.speed_mps));
  }
  return {};
}

/// Searches on one setting. `also_from`: gains that may be a good start as well.
Result<Tuning> tune_on(const ObjectiveSetting& setting, const ConstraintContext& context,
                       const TuneOptions& options,
                       const std::optional<Gains<double>>& also_from = {}) {
  const std::span<const YawMode> modes = yaw_modes(setting.vehicle);
  const Candidate start = feasible_start(options, context, kPaperGains);
  if (start.violation > 0.0) return infeasible(start, context);
  std::vector<Gains<double>> starts{start.gains};
  if (also_from) {
    const Candidate other = feasible_start(options, context, *also_from);
    if (!(other.violation > 0.0)) starts.push_back(other.gains);
  }
  const Objective objective(setting, kPaperGains);
  AWMR_ASSIGN_OR_RETURN(const SearchResult found, search(options, context, objective, starts));
  if (!found.best) {
    if (auto missed = goal_missed(found, objective, setting.scenarios)) return *missed;
    return not_better(found, objective, modes);
  }
  const SettledGains settled = settle(options, context, objective, *found.best);
  AWMR_ASSIGN_OR_RETURN(std::vector<ActiveConstraint> active,
                        active_constraints(options, context, objective, *found.best));
  const Gains<double>& gains = settled.gains;
  const Evaluation tuned = objective(gains);
  if (!beats_everywhere(tuned)) return not_better(found, objective, modes);
  ObjectiveSetting elsewhere = setting;
  elsewhere.scenarios = {held_out_scenario()};
  elsewhere.goals.clear();
  const Evaluation judged = Objective(std::move(elsewhere), kPaperGains)(gains);

  return Tuning{.gains = gains,
                .constraints = constraints_of(gains, context),
                .objective = tuned.objective,
                .scores = tuned.scores,
                .baseline = kPaperGains,
                .baseline_objective = objective.baseline().objective,
                .baseline_scores = objective.baseline().scores,
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
                .held_out_scores = judged.scores,
                .held_out_objective = judged.objective,
                .robust = {}};
}

/// The work of a constraint grows with the cube of the latency in samples.
Status check_latency(const ConstraintContext& context, const std::string& model_file) {
  const double samples = context.latency_s / context.sample_time_s;
  if (samples < kMostLateSamples + 0.5) return {};
  return input_error(
      model_file + ":/vehicle/latency_s",
      fmt::format("{:g} s are {:.0f} samples of {:g} s, more than the {} that gains are tuned for: "
                  "give a longer sample_time_s, or tune without latency ({})",
                  context.latency_s, samples, context.sample_time_s, kMostLateSamples,
                  option_text("nominal")));
}

/// Draws to judge on are not those that were tuned on.
constexpr std::uint64_t kJudgedSeeds = 0x6a75646765ULL;

/// The numbers of the fresh draws, from 1: those of the part, or all.
std::vector<int> judged_draws_of(const TuneOptions& options) {
  const Shard shard = options.shard.value_or(Shard{});
  std::vector<int> draws(at(shard.share_of(options.judged_draws)));
  for (int i = 0; int& draw : draws) draw = shard.item(i++) + 1;
  return draws;
}

/// The tuned gains and the baseline, and beside them those without their observer and the nominal ones.
std::vector<NamedCandidate> candidates_of(const Tuning& tuning,
                                          const std::optional<Gains<double>>& nominal) {
  std::vector<NamedCandidate> candidates{{"robust", tuning.gains}, {"baseline", tuning.baseline}};
  if (tuning.gains.observer.is_on()) {
    Gains<double> unobserved = tuning.gains;
    unobserved.observer = {};
    candidates.push_back({"unobserved", unobserved});
  }
  if (nominal) candidates.push_back({"nominal", *nominal});
  return candidates;
}

/// Runs the candidates on fresh draws, and judges them where these are all of the draws.
Status judge(const Model& model, ObjectiveSetting setting, const TuneOptions& options,
             const std::vector<NamedCandidate>& candidates, RobustTuning& robust) {
  if (options.judged_draws == 0) return {};
  setting.seed ^= kJudgedSeeds;
  const std::vector<int> draws = judged_draws_of(options);
  AWMR_ASSIGN_OR_RETURN(setting.vehicles, vehicles_of(model, draws, setting.seed, options.open));
  setting.numbers = {0};
  setting.numbers.insert(setting.numbers.end(), draws.begin(), draws.end());
  std::vector<JudgedRuns> runs = run_candidates(setting, candidates);
  if (options.shard) {
    robust.runs = std::move(runs);
    return {};
  }
  const std::span<const YawMode> modes = yaw_modes(model.vehicle);
  std::vector<std::string> names;
  for (const Scenario& scenario : setting.scenarios) names.push_back(scenario.name);
  Judgement judgement = judgement_of(runs, {.modes = {modes.begin(), modes.end()},
                                            .scenarios = std::move(names),
                                            .tail_share = options.tail_share,
                                            .goals = options.goals});
  robust.judged = std::move(judgement.gains);
  robust.judged_by_scenario = std::move(judgement.by_scenario);
  robust.goals = std::move(judgement.goals);
  return {};
}

/// The progress of a search whose evaluations count `weight` each, behind `before` of `total`.
Progress part_of(const Progress& progress, std::size_t before, std::size_t weight,
                 std::size_t total) {
  if (!progress) return {};
  return [=](std::size_t done, std::size_t) { progress(before + weight * done, total); };
}

/// `setting` and `context` are those of the nominal search.
Result<Tuning> tune_robustly(const Model& model, ObjectiveSetting setting,
                             ConstraintContext context, const TuneOptions& options) {
  TuneOptions nominal_options = options;
  nominal_options.nominal = true;
  nominal_options.goals.clear();
  nominal_options.open = {};
  nominal_options.sensitivity = 0;
  const auto plants = static_cast<std::size_t>(options.draws) + 1;
  const std::size_t evaluations = at(options.global_evaluations) + at(options.local_evaluations);
  const int robust_global = static_cast<int>(std::ceil(kRobustShare * options.global_evaluations));
  const std::size_t total =
      evaluations + plants * static_cast<std::size_t>(robust_global + options.local_evaluations);
  nominal_options.progress = part_of(options.progress, 0, 1, total);
  const Result<Tuning> nominal = tune_on(setting, context, nominal_options);

  RobustTuning robust{.conditions = conditions_of(model.vehicle),
                      .from_covariance = !model.covariance.parameters.empty(),
                      .nominal = {},
                      .nominal_history = {},
                      .judged = {},
                      .judged_by_scenario = {},
                      .goals = {},
                      .runs = {},
                      .sensitivity = {}};
  const LoopConditions& c = robust.conditions;
  const ObjectiveSetting without_noise = setting;
  AWMR_ASSIGN_OR_RETURN(setting.vehicles,
                        vehicles_of(model, options.draws, options.seed, options.open));
  for (Scenario& scenario : setting.scenarios) scenario = under(c, std::move(scenario));
  setting.goals = options.goals;
  context.draws.assign(setting.vehicles.begin() + 1, setting.vehicles.end());
  context.heading_noise_rad = radians(c.heading_noise_deg);
  context.latency_s = std::max(c.heading_late_s, c.yaw_rate_late_s);
  context.motor_time_constant_s = c.motor_time_constant_s;
  AWMR_RETURN_IF_ERROR(check_latency(context, model.file));
  TuneOptions robust_options = options;
  robust_options.global_evaluations = robust_global;
  robust_options.progress = part_of(options.progress, evaluations, plants, total);
  const auto nominal_gains = nominal ? std::optional(nominal->gains) : std::nullopt;
  AWMR_ASSIGN_OR_RETURN(Tuning tuning, tune_on(setting, context, robust_options, nominal_gains));

  robust.nominal = nominal_gains;
  if (nominal) robust.nominal_history = nominal->history;
  AWMR_RETURN_IF_ERROR(
      judge(model, setting, options, candidates_of(tuning, nominal_gains), robust));
  if (options.sensitivity > 0) {
    AWMR_ASSIGN_OR_RETURN(robust.sensitivity,
                          global_sensitivity(model, without_noise, robust.conditions, tuning.gains,
                                             options.sensitivity));
  }
  tuning.robust = std::move(robust);
  return tuning;
}

}  // namespace

Scenario default_tuning_scenario() {
  return heading_steps({30.0, -30.0}, {.name = "heading_30_-30"});
}

Result<std::vector<Scenario>> default_tuning_scenarios(const Model& model,
                                                       const TuneOptions& options,
                                                       const HeadingRateChoice& said) {
  std::vector<Scenario> scenarios{default_tuning_scenario()};
  const std::optional<double> measured_degps = measured_yaw_rate_degps(model);
  if (said.empty() && measured_degps) {
    Scenario led = scenarios.front();
    led.name += kLedSuffix;
    limit_heading_rate(*measured_degps, led);
    scenarios.push_back(std::move(led));
  }
  if (!options.observer) return scenarios;
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  const ConstraintContext context = context_of(options, plant, model.vehicle, scenarios);
  Scenario pushed = scenarios.back();
  pushed.name += "_pushed";
  const auto constantly = [](double value) {
    DisturbanceTerm term;
    term.value = value;
    return std::vector{term};
  };
  pushed.disturbance.yaw =
      constantly(kPush * turning_authority_m(context.own(), context.speed_mps));
  pushed.disturbance.surge = constantly(-kPush * plant.surge(pushed.speed_mps));
  scenarios.push_back(std::move(pushed));
  return scenarios;
}

Scenario held_out_scenario() {
  return heading_steps({60.0, 0.0}, {.speed_mps = 0.7, .name = "held_out_60_0"});
}

Result<Tuning> tune(const Model& model, const TuneOptions& asked) {
  TuneOptions options = asked;
  AWMR_RETURN_IF_ERROR(check(options, model.vehicle));
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant());
  AWMR_ASSIGN_OR_RETURN(const BatchArithmetic arithmetic, batch_arithmetic());
  std::vector<Scenario> scenarios = options.scenarios;
  if (scenarios.empty()) {
    AWMR_ASSIGN_OR_RETURN(scenarios, default_tuning_scenarios(model, options));
  }
  AWMR_RETURN_IF_ERROR(check_work(options, scenarios, plant, model));
  ObjectiveSetting setting{.vehicles = {{plant, model.vehicle.wheel_force}},
                           .vehicle = model.vehicle,
                           .weights = options.weights,
                           .scenarios = std::move(scenarios),
                           .tail_share = options.tail_share,
                           .seed = options.seed,
                           .arithmetic = arithmetic};
  ConstraintContext context = context_of(options, plant, model.vehicle, setting.scenarios);
  AWMR_RETURN_IF_ERROR(limit_observer(context, options.observer));
  if (options.nominal) return tune_on(setting, context, options);
  return tune_robustly(model, std::move(setting), std::move(context), options);
}

}  // namespace awmr
