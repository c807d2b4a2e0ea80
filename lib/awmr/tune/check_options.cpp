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
#include "awmr/model/observer_rate.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/tuning_steps.h"

namespace awmr {
namespace {

/// Adds a fault for each number of option_table.h that is outside of its range.
struct CheckOption {
  std::vector<Fault>& faults;
  std::string of = {};  ///< text before the key in the message, such as "limits: "

  template <class Value>
  void operator()(const char* key, const Value& value, const NumberRule& rule) const {
    if (!allows(rule, value)) fault(key, fmt::format("{}", value), rule);
  }
  void operator()(const char* key, const Interval& value, const NumberRule& rule) const {
    if (!allows(rule, value)) fault(key, fmt::format("[{}, {}]", value.lo, value.hi), rule);
  }
  template <class Value>
  void operator()(const char* key, const std::optional<Value>& value,
                  const NumberRule& rule) const {
    if (value) (*this)(key, *value, rule);
  }

 private:
  void fault(const char* key, const std::string& found, const NumberRule& rule) const {
    faults.push_back(
        {ErrorCode::kOutOfRange, "",
         fmt::format("{}{}: found {}, but {} is needed", of, key, found, describe(rule))});
  }
};

void check_scenarios(const std::vector<Scenario>& scenarios, bool observer_is_searched,
                     std::vector<Fault>& faults) {
  std::set<std::string> names;
  for (const Scenario& scenario : scenarios) {
    if (!std::holds_alternative<HeadingSteps>(scenario.guidance)) {
      faults.push_back({ErrorCode::kUnsupported, "",
                        fmt::format("scenario '{}' commands no headings; gains are tuned on "
                                    "heading steps, so give guidance of type 'heading'",
                                    scenario.name)});
    }
    if (scenario.held_tau_speed()) {
      faults.push_back({ErrorCode::kUnsupported, "",
                        fmt::format("scenario '{}' replaces the speed law by a constant tau_speed, "
                                    "so the gains of this law cannot be tuned; remove "
                                    "tau_speed, and give speed_mps",
                                    scenario.name)});
    }
    if (scenario.control.lqi) {
      faults.push_back({ErrorCode::kUnsupported, "",
                        fmt::format("scenario '{}' uses the heading law lqi, which has no "
                                    "gains to tune; use sliding_mode",
                                    scenario.name)});
    }
    if (observer_is_searched && scenario.control.observer) {
      faults.push_back({ErrorCode::kConflict, "",
                        fmt::format("scenario '{}' sets a disturbance_observer, but tune also "
                                    "searches an observer; remove one of the two",
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

void check_open(const TuneOptions& options, std::vector<Fault>& faults) {
  const UnmodelledVariation& open = options.open;
  if (!open.any()) return;
  if (options.nominal) {
    faults.push_back({ErrorCode::kConflict, "",
                      "`open` varies the mass and wheel forces of randomly drawn vehicles, but "
                      "`nominal` draws none; remove one of the two"});
    return;
  }
  for (const double factor : open.mass_factors) {
    if (allows(kMassFactor, factor)) continue;
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("open: the mass factor {} is out of range; give a factor in {} "
                                  "... {}",
                                  factor, kMassFactor.min, kMassFactor.max)});
  }
  for (const Interval& force : open.wheel_forces) {
    if (force.lo >= -1.0 && force.lo < force.hi && force.hi > 0.0 && force.hi <= 1.0) continue;
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("open: found the wheel forces [{}, {}]; give forces with -1 <= "
                                  "min < max and 0 < max <= 1",
                                  force.lo, force.hi)});
  }
  if (std::max(open.mass_factors.size(), open.wheel_forces.size()) > kMaxOpenValues) {
    faults.push_back({ErrorCode::kTooLarge, "",
                      fmt::format("open: mass_factors or wheel_forces has more than {} values; "
                                  "give fewer",
                                  kMaxOpenValues)});
  }
  const auto fewest = static_cast<int>(open.combinations());
  for (const auto& [name, count] :
       {std::pair("draws", options.draws), std::pair("judged_draws", options.evaluation_draws)}) {
    if (count >= fewest || (count == 0 && name == std::string_view("judged_draws"))) continue;
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("{}: {} does not cover all {} combinations of `open`; give {} "
                                  "or a multiple of it",
                                  name, count, fewest, fewest)});
  }
}

void check_goal(const TuningGoal& goal, std::vector<Fault>& faults) {
  const std::vector<std::string> known = run_figure_names();
  std::set<std::string> figures;
  for (const auto& [figure, most] : goal.at_most) {
    if (std::ranges::find(known, figure) == known.end() || !figures.insert(figure).second) {
      faults.push_back({ErrorCode::kUnknownName, "",
                        fmt::format("goals: the metric {} is unknown or given twice; available: {}",
                                    figure, fmt::join(known, ", "))});
    }
    if (!allows(kGoalLimit, most)) {
      faults.push_back({ErrorCode::kOutOfRange, "",
                        fmt::format("goals: {} has the limit {}, which is not above 0 or out of "
                                    "range; give a number in {} ... {}",
                                    figure, most, kGoalLimit.min, kGoalLimit.max)});
    }
  }
  if (figures.empty()) {
    faults.push_back(
        {ErrorCode::kMissing, "",
         "goals: a goal is without a limit; give at least one metric with its limit in `at_most`"});
  }
  if (!allows(kGoalShare, goal.share)) {
    faults.push_back({ErrorCode::kOutOfRange, "",
                      fmt::format("goals: the share {} is out of range; give a number in {} ... {}",
                                  goal.share, kGoalShare.min, kGoalShare.max)});
  }
}

/// Rejects limits on the damping with latency and motor lag in a nominal search, which has neither.
void check_late_limits(const TuneOptions& options, std::vector<Fault>& faults) {
  const TuningLimits unchanged;
  for (const auto& [key, limit] : {std::pair("late_damping", &TuningLimits::late_damping),
                                   std::pair("delayed_damping", &TuningLimits::delayed_damping)}) {
    if (!options.nominal || options.limits.*limit == unchanged.*limit) continue;
    faults.push_back({ErrorCode::kConflict, "",
                      fmt::format("limits: {} applies to the heading loop with latency and motor "
                                  "lag, which nominal disables; remove this limit or nominal",
                                  key)});
  }
}

void check_mode(const TuneOptions& options, const Vehicle& vehicle, std::vector<Fault>& faults) {
  if (!options.mode) return;
  if (options.one_set) {
    faults.push_back({ErrorCode::kConflict, "",
                      "one_set requests one set of gains for all modes, but \"mode\" tunes for one "
                      "mode only; remove one of the two"});
  }
  const std::span<const YawMode> modes = yaw_modes(vehicle);
  if (std::ranges::find(modes, *options.mode) == modes.end()) {
    faults.push_back(
        {ErrorCode::kUnsupported, "",
         fmt::format(
             "mode: a vehicle of drive \"{}\" has no mode {}; remove \"mode\" or give another mode",
             name_in(kDriveNames, vehicle.drive), name_of(*options.mode))});
  }
  for (const TuningGoal& goal : options.goals) {
    if (!goal.mode || *goal.mode == *options.mode) continue;
    faults.push_back({ErrorCode::kConflict, "",
                      fmt::format("goals: a goal is for mode {}, but \"mode\" tunes {} only; "
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
                      "goals need randomly drawn vehicles, which nominal disables; remove one of "
                      "the two"});
  }
  if (options.evaluation_draws == 0) {
    faults.push_back({ErrorCode::kConflict, "",
                      "goals are evaluated on newly drawn vehicles, so their number judged_draws "
                      "has to be above 0; increase it, or remove the goals"});
  }
  if (options.goals.size() > kMaxGoals) {
    faults.push_back(
        {ErrorCode::kTooLarge, "",
         fmt::format("goals: {} goals are given, but at most {} are allowed; remove some",
                     options.goals.size(), kMaxGoals)});
  }
  for (const TuningGoal& goal : options.goals) check_goal(goal, faults);
}

}  // namespace

Status check_options(const TuneOptions& options, const Vehicle& vehicle) {
  std::vector<Fault> faults;
  check_mode(options, vehicle, faults);
  check_goals(options, vehicle, faults);
  search_options(options, CheckOption{faults});
  limit_options(options.limits, CheckOption{faults, "limits: "});
  check_late_limits(options, faults);
  weight_options(options.weights, CheckOption{faults, "weights: "});
  bound_options(options.bounds, CheckOption{faults, "bounds: "});
  if (options.observer) {
    observer_options(*options.observer, CheckOption{faults, "observer: "});
    const double slowest = options.observer->bandwidth_radps.lo;
    if (const Status rate = check_observer_rate(slowest, vehicle.sample_time_s, ""); !rate) {
      const Fault& fault = rate.error().faults.front();
      faults.push_back({fault.code, "", "observer: bandwidth_radps: " + fault.message});
    }
  }
  if (!has_weight(options.weights)) {
    faults.push_back(
        {ErrorCode::kOutOfRange, "", "weights: all weights are 0; give at least one above 0"});
  }
  check_open(options, faults);
  check_scenarios(options.scenarios, options.observer.has_value(), faults);
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

}  // namespace awmr
