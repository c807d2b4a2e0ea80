#include "awmr/tune/check_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "awmr/core/option_text.h"
#include "awmr/tune/global_sensitivity.h"
#include "awmr/tune/goals.h"

namespace awmr {
namespace {

bool is_positive(double value) { return value > 0.0 && std::isfinite(value); }

void check_bounds(const std::optional<Interval>& range, const char* name,
                  std::vector<Fault>& faults) {
  if (!range || (range->lo > 0.0 && range->lo <= range->hi && std::isfinite(range->hi))) return;
  faults.push_back({ErrorCode::kWrongOrder, "",
                    fmt::format("bounds of {}: [{}, {}], but 0 < lo <= hi is needed", name,
                                range->lo, range->hi)});
}

void check_observer(const std::optional<ObserverSearch>& observer, std::vector<Fault>& faults) {
  if (!observer) return;
  check_bounds(observer->bandwidth_radps, "the observer's bandwidth_radps", faults);
  for (const auto& [name, limit] :
       {std::pair("yaw_max_m", observer->yaw_max_m), std::pair("surge_max", observer->surge_max)}) {
    if (!limit || (*limit > 0.0 && std::isfinite(*limit))) continue;
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("the observer's {}: {} is not above 0", name, *limit)});
  }
}

void check_weights(const ObjectiveWeights& w, std::vector<Fault>& faults) {
  const double values[] = {w.settling,          w.itae,   w.overshoot,
                           w.control_variation, w.effort, w.speed_itae};
  double sum = 0.0;
  for (const double value : values) {
    if (!(value >= 0.0)) {
      faults.push_back({ErrorCode::kOutOfRange, "", fmt::format("weights: {} is below 0", value)});
    }
    sum += value;
  }
  if (!(sum > 0.0) || !std::isfinite(sum)) {
    faults.push_back(
        {ErrorCode::kOutOfRange, "", "weights: all must be finite, and at least one above 0"});
  }
}

void check_scenarios(const std::vector<Scenario>& scenarios, bool observer_is_searched,
                     std::vector<Fault>& faults) {
  std::set<std::string> names;
  for (const Scenario& scenario : scenarios) {
    if (!std::holds_alternative<HeadingSteps>(scenario.guidance)) {
      faults.push_back({ErrorCode::kUnsupported, "",
                        fmt::format("scenario '{}' commands no headings; give guidance of "
                                    "type 'heading', on which gains are tuned",
                                    scenario.name)});
    }
    if (scenario.held_tau_speed()) {
      faults.push_back({ErrorCode::kUnsupported, "",
                        fmt::format("scenario '{}' has constant tau_speed, so its speed law "
                                    "has no target; give speed_mps instead",
                                    scenario.name)});
    }
    if (scenario.control.lqi) {
      faults.push_back({ErrorCode::kUnsupported, "",
                        fmt::format("scenario '{}' uses the heading law lqi, which has no "
                                    "gains to tune; use sliding_mode",
                                    scenario.name)});
    }
    if (observer_is_searched && scenario.control.observer) {
      faults.push_back(
          {ErrorCode::kConflict, "",
           fmt::format("scenario '{}' sets a disturbance_observer and one is to be tuned; "
                       "remove one of the two",
                       scenario.name)});
    }
    if (!names.insert(scenario.name).second) {
      faults.push_back({ErrorCode::kGivenTwice, "",
                        fmt::format("two scenarios are named '{}'; scores are listed by "
                                    "name, so rename one",
                                    scenario.name)});
    }
  }
}

void check_robustness(const TuneOptions& options, std::vector<Fault>& faults) {
  if (options.draws < 0 || options.draws > 1000) {
    faults.push_back(
        {ErrorCode::kOutOfRange, "", fmt::format("draws: {} is not in 0 ... 1000", options.draws)});
  }
  if (options.evaluation_draws < 0 || options.evaluation_draws > 100000) {
    faults.push_back(
        {ErrorCode::kOutOfRange, "",
         fmt::format("judged_draws: {} is not in 0 ... 100000", options.evaluation_draws)});
  }
  if (!(options.tail_share > 0.0 && options.tail_share <= 1.0)) {
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("tail_share: {} is not in (0, 1]", options.tail_share)});
  }
  if (options.activity_max && !is_positive(*options.activity_max)) {
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("activity_max: {} is not above 0", *options.activity_max)});
  }
}

void check_limits(const TuningLimits& limits, std::vector<Fault>& faults) {
  if (limits.steering_rate_rms_degps && !is_positive(*limits.steering_rate_rms_degps)) {
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("limits: steering_rate_rms_degps {} is not above 0",
                                  *limits.steering_rate_rms_degps)});
  }
  const std::pair<const char*, double> shares[] = {{"damping", limits.damping},
                                                   {"late_damping", limits.late_damping},
                                                   {"delayed_damping", limits.delayed_damping},
                                                   {"noise_share", limits.noise_share}};
  for (const auto& [name, share] : shares) {
    if (share > 0.0 && share <= 1.0) continue;
    faults.push_back(
        {ErrorCode::kOutOfRange, "", fmt::format("limits: {} {} is not in (0, 1]", name, share)});
  }
}

void check_open(const TuneOptions& options, std::vector<Fault>& faults) {
  const UnmodelledVariation& open = options.open;
  if (!open.any()) return;
  if (options.nominal) {
    faults.push_back(
        {ErrorCode::kConflict, "",
         "`open` varies the sampled plants, which nominal disables; remove one of the two"});
    return;
  }
  for (const double factor : open.mass_factors) {
    if (factor >= kLeastMassFactor && factor <= kMostMassFactor) continue;
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("open: a mass factor of {} is not in {} ... {}", factor,
                                  kLeastMassFactor, kMostMassFactor)});
  }
  for (const Interval& force : open.wheel_forces) {
    if (force.lo >= -1.0 && force.lo < force.hi && force.hi > 0.0 && force.hi <= 1.0) continue;
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("open: wheel forces of [{}, {}], but -1 <= min < max and 0 < "
                                  "max <= 1 is needed",
                                  force.lo, force.hi)});
  }
  if (std::max(open.mass_factors.size(), open.wheel_forces.size()) > kMostOpenValues) {
    faults.push_back({ErrorCode::kTooLarge, "",
                      fmt::format("open: mass_factors or wheel_forces has more than {} values",
                                  kMostOpenValues)});
  }
  const auto fewest = static_cast<int>(open.combinations());
  for (const auto& [name, count] :
       {std::pair("draws", options.draws), std::pair("judged_draws", options.evaluation_draws)}) {
    if (count >= fewest || (count == 0 && name == std::string_view("judged_draws"))) continue;
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("{}: {} does not cover all {} combinations of `open`; give a "
                                  "multiple of {}",
                                  name, count, fewest, fewest)});
  }
}

void check_part(const TuneOptions& options, std::vector<Fault>& faults) {
  if (!options.shard) return;
  if (options.nominal) {
    faults.push_back({ErrorCode::kConflict, option_text("shard"),
                      "nominal disables the draws that a shard divides; remove one of the two"});
  }
  if (auto fault =
          shard_fault(*options.shard, options.evaluation_draws, "fresh draws (judged_draws)")) {
    faults.push_back(std::move(*fault));
  }
}

void check_goal(const TuningGoal& goal, std::vector<Fault>& faults) {
  std::set<std::string> figures;
  for (const auto& [figure, most] : goal.at_most) {
    if (!is_run_figure(figure) || !figures.insert(figure).second) {
      faults.push_back({ErrorCode::kUnknownName, "",
                        fmt::format("goals: {} is unknown or given twice; available: {}", figure,
                                    fmt::join(run_figure_names(), ", "))});
    }
    if (!(most > 0.0) || !std::isfinite(most)) {
      faults.push_back({ErrorCode::kOutOfRange, "",
                        fmt::format("goals: {} at most {} is not above 0", figure, most)});
    }
  }
  if (figures.empty()) {
    faults.push_back({ErrorCode::kMissing, "",
                      "goals: a goal is without a limit; give at_most at least one metric"});
  }
  if (!(goal.share >= kLeastShare && goal.share <= kMostShare)) {
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("goals: a share of {} is not in {} ... {}", goal.share,
                                  kLeastShare, kMostShare)});
  }
}

void check_sensitivity(const TuneOptions& options, std::vector<Fault>& faults) {
  if (options.sensitivity == 0) return;
  if (options.sensitivity < kFewestSamples || options.sensitivity > kMostSamples) {
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("sensitivity: {} is neither 0 nor in {} ... {}",
                                  options.sensitivity, kFewestSamples, kMostSamples)});
  }
  if (options.nominal) {
    faults.push_back({ErrorCode::kConflict, "",
                      "sensitivity needs sampled plants, which nominal disables; remove one of the "
                      "two"});
  }
}

void check_mode(const TuneOptions& options, const Vehicle& vehicle, std::vector<Fault>& faults) {
  if (!options.mode) return;
  const std::span<const YawMode> modes = yaw_modes(vehicle);
  if (std::ranges::find(modes, *options.mode) == modes.end()) {
    faults.push_back({ErrorCode::kUnsupported, "",
                      fmt::format("mode: a vehicle of drive \"{}\" has no mode {}; remove \"mode\" "
                                  "or give another",
                                  name_in(kDriveNames, vehicle.drive), name_of(*options.mode))});
  }
  for (const TuningGoal& goal : options.goals) {
    if (!goal.mode || *goal.mode == *options.mode) continue;
    faults.push_back({ErrorCode::kConflict, "",
                      fmt::format("goals: one is for mode {}, but \"mode\" tunes {} only; "
                                  "remove the goal or \"mode\"",
                                  name_of(*goal.mode), name_of(*options.mode))});
  }
}

void check_goals(const TuneOptions& options, const Vehicle& vehicle, std::vector<Fault>& faults) {
  if (options.goals.empty()) return;
  const std::span<const YawMode> modes = yaw_modes(vehicle);
  for (const TuningGoal& goal : options.goals) {
    if (goal.mode && std::ranges::find(modes, *goal.mode) == modes.end()) {
      faults.push_back({ErrorCode::kUnsupported, "",
                        fmt::format("goals: a vehicle of drive \"{}\" has no mode {}; change the "
                                    "goal's mode or remove it",
                                    name_in(kDriveNames, vehicle.drive), name_of(*goal.mode))});
    }
  }
  if (options.nominal) {
    faults.push_back({ErrorCode::kConflict, "",
                      "goals need sampled plants, which nominal disables; remove one of the two"});
  }
  if (options.evaluation_draws == 0) {
    faults.push_back({ErrorCode::kConflict, "",
                      "goals are evaluated on fresh draws; judged_draws has to be above 0"});
  }
  if (options.goals.size() > kMostGoals) {
    faults.push_back(
        {ErrorCode::kTooLarge, "",
         fmt::format("goals: {} goals; at most {} are allowed", options.goals.size(), kMostGoals)});
  }
  for (const TuningGoal& goal : options.goals) check_goal(goal, faults);
}

}  // namespace

Status check_options(const TuneOptions& options, const Vehicle& vehicle) {
  std::vector<Fault> faults;
  check_mode(options, vehicle, faults);
  check_goals(options, vehicle, faults);
  check_sensitivity(options, faults);
  if (!(options.margin > 0.0 && options.margin < 1.0)) {
    faults.push_back(
        {ErrorCode::kOutOfRange, "", fmt::format("margin: {} is not in (0, 1)", options.margin)});
  }
  if (options.global_evaluations < 1 || options.local_evaluations < 0) {
    faults.push_back({ErrorCode::kOutOfRange, "",
                      "global_evaluations must be at least 1, local_evaluations at least 0"});
  }
  check_robustness(options, faults);
  check_limits(options.limits, faults);
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

}  // namespace awmr
