#include "awmr/tune/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ranges>
#include <utility>

#include "awmr/core/containers.h"
#include "awmr/core/parallel.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/steering_rate.h"

namespace awmr {
namespace {

/// NLopt minimises one number for each point. If a point is not simulated, or its runs break off,
/// this number is kRejected + violation. kRejected is larger than the objective of any useful
/// gains.
constexpr double kRejected = 1e3;
/// Added to the residuals of all constraints if a run breaks off.
constexpr double kInvalid = 1.0;

}  // namespace

void bound_around(std::span<const Gains<double>> gains, GainBounds& bounds) {
  for (const SearchedGain& searched : kSearchedGains) {
    std::optional<Interval>& bound = bounds.*searched.bounds;
    if (bound) continue;
    const auto [least, largest] = std::ranges::minmax(
        gains | std::views::transform([&](const Gains<double>& one) { return searched.of(one); }));
    bound = Interval{least / kBoundFactor, largest * kBoundFactor};
  }
}

static_assert(std::size(kSearchedGains) + 1 == kMaxDimensions);  // the last one is the observer

SearchSpace::SearchSpace(const TuneOptions& options) : observer_(options.observer) {
  range_.back() = observer_ ? observer_->bandwidth_radps : Interval{1.0, 1.0};
  std::ranges::transform(kSearchedGains, range_.begin(), [&](const SearchedGain& searched) {
    return *(options.bounds.*searched.bounds);
  });
  for (unsigned i = 0; i < kMaxDimensions; ++i) {
    lower_corner_[i] = std::log(range_[i].lo);
    upper_corner_[i] = std::log(range_[i].hi);
  }
}

Gains<double> SearchSpace::gains_at(const Point& x) const {
  Point g{};
  for (unsigned i = 0; i < kMaxDimensions; ++i) {
    g[i] = std::clamp(std::exp(x[i]), range_[i].lo, range_[i].hi);
  }
  Gains<double> gains{{g[0], g[1], g[2]}, {g[3], g[4]}};
  if (observer_) gains.observer = {g[5], *observer_->yaw_max_m, *observer_->surge_max};
  return gains;
}

Point SearchSpace::point_of(const Gains<double>& gains) const {
  Point x{};
  x.back() = gains.observer.bandwidth_radps;
  std::ranges::transform(kSearchedGains, x.begin(),
                         [&](const SearchedGain& searched) { return searched.of(gains); });
  for (unsigned i = 0; i < kMaxDimensions; ++i) {
    x[i] = std::log(std::clamp(x[i], range_[i].lo, range_[i].hi));
  }
  return x;
}

bool better(const Candidate& a, const Candidate& b) {
  if (a.feasible() != b.feasible()) return a.feasible();
  if (a.meets_constraints != b.meets_constraints) return a.meets_constraints;
  return a.feasible() ? a.objective < b.objective : a.violation < b.violation;
}

double Looked::value() const {
  return candidate.simulated && candidate.valid ? candidate.objective
                                                : kRejected + candidate.violation;
}

Problem::Problem(const TuneOptions& options, const ConstraintContext& context,
                 const Objective& objective)
    : options_(options), space_(options), context_(context), objective_(objective) {
  nearest.violation = std::numeric_limits<double>::infinity();
  for (const ConstraintReport& c :
       constraints_of(Gains<double>{{1.0, 1.0, 1.0}, {1.0, 1.0}}, context_)) {
    if (c.required && c.name == kSteeringRate) steering_rate_ = names_.size();
    if (c.required) names_.push_back(c.name);
  }
  before_runs_ = names_.size();
  const std::span<const YawMode> modes = objective_.modes();
  if (options_.activity_max) {
    for (const YawMode mode : modes) names_.push_back(fmt::format("activity, {}", name_of(mode)));
  }
  const std::vector<GoalInMode> goals = by_mode(objective_.goals(), modes);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    if (goals[i].goal->is_soft) continue;
    hard_goals_.push_back(i);
    names_.push_back(goals[i].name());
  }
  tolerated.assign(names_.size(), 0.0);
}

Looked Problem::before_runs(const Point& point) const {
  const double wider = steering_rate_ ? tolerated[*steering_rate_] : 0.0;
  Looked looked{
      .point = point,
      .candidate = {.gains = with_friction_width(space_.gains_at(point), context_, wider)}};
  looked.residuals = awmr::residuals(constraints_of(looked.candidate.gains, context_));
  for (std::size_t i = 0; i < looked.residuals.size(); ++i) looked.residuals[i] -= tolerated[i];
  looked.candidate.violation = *std::ranges::max_element(looked.residuals);
  looked.candidate.meets_constraints = looked.candidate.violation <= 0.0;
  looked.residuals.resize(constraints(), 0.0);
  return looked;
}

void Problem::add_runs(const Evaluation& e, Looked& looked) const {
  Candidate& candidate = looked.candidate;
  candidate.simulated = true;
  candidate.valid = e.valid;
  candidate.meets_constraints = candidate.meets_constraints && e.valid;
  candidate.objective = e.objective;
  std::vector<double> broken;
  if (options_.activity_max) {
    for (const double activity : e.mode_activity) {
      broken.push_back(activity / *options_.activity_max - 1.0);
    }
  }
  for (const std::size_t goal : hard_goals_) broken.push_back(e.goal_quantile[goal] - 1.0);
  for (std::size_t i = 0; i < broken.size(); ++i) {
    double& residual = looked.residuals[before_runs_ + i];
    residual = broken[i] - tolerated[before_runs_ + i];
    candidate.violation = std::max(candidate.violation, residual);
  }
  if (e.valid) return;
  for (double& residual : looked.residuals) {
    residual = kInvalid + (std::isfinite(residual) ? std::max(residual, 0.0) : kRejected);
    candidate.violation = std::max(candidate.violation, residual);
  }
}

std::vector<Looked> Problem::look_at(std::span<const Point> points) {
  std::vector<Looked> all(points.size());
  parallel_for(points.size(), 0, [&](std::size_t i) { all[i] = before_runs(points[i]); });
  std::vector<Gains<double>> to_run;
  for (const Looked& looked : all) {
    if (looked.candidate.violation <= 0.0 || simulate_all) to_run.push_back(looked.candidate.gains);
  }
  const std::vector<Evaluation> found = objective_(to_run);
  auto next = found.begin();
  for (Looked& looked : all) {
    if (looked.candidate.violation <= 0.0 || simulate_all) {
      add_runs(*next, looked);
      if (looked.candidate.feasible()) met.push_back({next->trade_off, looked.candidate.gains});
      ++next;
    }
    ++evaluations;
    if (!better(looked.candidate, nearest)) continue;
    nearest = looked.candidate;
    if (nearest.feasible()) steps.push_back({evaluations, nearest.objective});
  }
  simulated += static_cast<int>(found.size());
  report();
  return all;
}

Problem Problem::unused() const {
  Problem same(options_, context_, objective_);
  same.simulate_all = simulate_all;
  same.tolerated = tolerated;
  same.reports_ = false;
  return same;
}

void Problem::add(const Problem& part) {
  for (const SearchStep& step : part.steps) {
    if (nearest.feasible() && !(step.objective < nearest.objective)) continue;
    steps.push_back({evaluations + step.evaluation, step.objective});
  }
  if (better(part.nearest, nearest)) nearest = part.nearest;
  evaluations += part.evaluations;
  simulated += part.simulated;
  append(met, part.met);
  report();
}

void Problem::report() const {
  if (!reports_ || !options_.progress) return;
  const auto total = static_cast<std::size_t>(options_.global_evaluations) +
                     static_cast<std::size_t>(options_.local_evaluations);
  // The evaluations at the starts of the search are not part of the budget, so the count can exceed
  // the budget.
  options_.progress(std::min(static_cast<std::size_t>(evaluations), total), total);
}

}  // namespace awmr
