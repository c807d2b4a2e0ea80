#include <algorithm>
#include <array>
#include <cmath>

#include "awmr/tune/search.h"
#include "awmr/tune/tuning_steps.h"

namespace awmr {
namespace {

/// Bisection steps for each end of an interval.
constexpr int kHalvings = 6;
/// Fractions of the reduction of mu and mu_s that are tried on all draws, in this order. 0: the
/// best gains themselves.
constexpr double kReductions[] = {1.0, 0.75, 0.5, 0.25, 0.0};
/// A constraint is active if its residual is above this value. The residual is 0 at the limit and
/// negative if the constraint is met.
constexpr double kActive = -0.01;
/// Evaluations of the local search with a relaxed limit (active_constraints()).
constexpr int kPriceEvaluations = 30;

/// Indices in a Point of two gains of which mostly the ratio matters: mu and epsilon, or mu_s and
/// epsilon_s.
using Pair = std::array<unsigned, 2>;
constexpr Pair kHeading{1, 2};
constexpr Pair kSpeed{3, 4};

Point scaled(Point point, const Pair& pair, double by_ln) {
  for (const unsigned i : pair) point[i] += by_ln;
  return point;
}

/// Range by which the logarithms of both gains of a pair, such as mu and epsilon, can be shifted
/// together without leaving the bounds.
Interval room(const Point& from, const Pair& pair, const SearchSpace& space) {
  const Point lower = space.lower_corner();
  const Point upper = space.upper_corner();
  return {std::max(lower[pair[0]] - from[pair[0]], lower[pair[1]] - from[pair[1]]),
          std::min(upper[pair[0]] - from[pair[0]], upper[pair[1]] - from[pair[1]])};
}

/// Range, around 0, by which the logarithms of both gains of a pair can be shifted together while
/// the gains meet every constraint and the objective is at most `most`. Found by bisection, because
/// the objective increases towards both ends.
Interval stretch(Problem& problem, const Point& from, const Pair& pair, double most) {
  const auto is_good = [&](double by_ln) {
    const Point point = scaled(from, pair, by_ln);
    const Candidate there = problem.look_at(std::span(&point, 1)).front().candidate;
    return there.feasible() && there.objective <= most;
  };
  const auto last_good = [&](double end) {
    if (is_good(end)) return end;
    double good = 0.0;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (good + end);
      (is_good(middle) ? good : end) = middle;
    }
    return good;
  };
  const Interval within = room(from, pair, problem.space());
  return {last_good(within.lo), last_good(within.hi)};
}

}  // namespace

SettledGains settle(const TuneOptions& options, const ConstraintContext& context,
                    const Objective& searched, const Objective& all, const Candidate& best) {
  TuneOptions quiet = options;
  quiet.progress = {};
  Problem problem(quiet, context, searched);
  const Point point = problem.space().point_of(best.gains);
  const double objective = problem.look_at(std::span(&point, 1)).front().candidate.objective;
  // Reducing mu may increase the objective by half of kIndifferent, reducing mu_s by the rest.
  const Interval heading =
      stretch(problem, point, kHeading, (1.0 + 0.5 * kIndifferent) * objective);
  const Interval speed = stretch(problem, scaled(point, kHeading, heading.lo), kSpeed,
                                 (1.0 + kIndifferent) * objective);
  std::vector<Point> reduced;
  for (const double share : kReductions) {
    reduced.push_back(
        scaled(scaled(point, kHeading, share * heading.lo), kSpeed, share * speed.lo));
  }
  Problem on_all(quiet, context, all);
  const auto seen = on_all.look_at(reduced);
  const double most = (1.0 + kIndifferent) * seen.back().candidate.objective;
  const auto chosen = std::find_if(seen.begin(), seen.end() - 1, [most](const auto& one) {
    return one.candidate.feasible() && one.candidate.objective <= most;
  });
  const bool is_reduced = chosen != seen.end() - 1;
  const Gains<double> gains = is_reduced ? chosen->candidate.gains : best.gains;
  return {gains,
          {gains.heading.mu, best.gains.heading.mu * std::exp(heading.hi)},
          {gains.speed.mu, best.gains.speed.mu * std::exp(speed.hi)}};
}

Result<std::vector<ActiveConstraint>> active_constraints(const TuneOptions& options,
                                                         const ConstraintContext& context,
                                                         const Objective& objective,
                                                         const Candidate& best) {
  TuneOptions quiet = options;
  quiet.progress = {};
  const Point point = SearchSpace(options).point_of(best.gains);
  // Returns the smallest objective that a local search finds if constraint number `wider` is
  // relaxed by kWider. If there is no such constraint, none is relaxed.
  const auto searched = [&](std::size_t wider) -> Result<double> {
    Problem problem(quiet, context, objective);
    if (wider < problem.tolerated.size()) problem.tolerated[wider] = kWider;
    problem.look_at(std::span(&point, 1));
    AWMR_RETURN_IF_ERROR(search_near(problem, kPriceEvaluations));
    return problem.nearest.objective;
  };
  Problem problem(quiet, context, objective);
  const std::vector<double> residuals = problem.look_at(std::span(&point, 1)).front().residuals;
  std::vector<ActiveConstraint> active;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals[i] > kActive) active.push_back({.name = problem.names()[i]});
  }
  if (active.empty()) return active;
  // A further search can find better gains even without a relaxed limit, so the improvement is
  // measured from the result of such a search.
  AWMR_ASSIGN_OR_RETURN(const double without, searched(residuals.size()));
  for (ActiveConstraint& one : active) {
    const auto place = std::ranges::find(problem.names(), one.name) - problem.names().begin();
    AWMR_ASSIGN_OR_RETURN(const double with, searched(static_cast<std::size_t>(place)));
    one.wider_gains = std::max(0.0, (without - with) / without);
  }
  return active;
}

}  // namespace awmr
