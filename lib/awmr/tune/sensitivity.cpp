#include "awmr/tune/sensitivity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "awmr/tune/search.h"

namespace awmr {
namespace {

/// Points looked at on either side, and then again between the last good one and the next.
constexpr int kPoints = 8;
/// A residual above this is that of an active constraint.
constexpr double kActive = -0.01;
/// Evaluations of the search for what a wider limit is worth.
constexpr int kPriceEvaluations = 30;

/// The places of a mu and its epsilon in a Point.
using Pair = std::array<unsigned, 2>;
constexpr Pair kHeading{1, 2};
constexpr Pair kSpeed{3, 4};

Point scaled(Point point, const Pair& pair, double by_ln) {
  for (const unsigned i : pair) point[i] += by_ln;
  return point;
}

/// Range in which the logarithms of a pair can be moved together within the bounds.
Interval room(const Point& from, const Pair& pair, const SearchSpace& space) {
  const Point lower = space.lower_corner();
  const Point upper = space.upper_corner();
  return {std::max(lower[pair[0]] - from[pair[0]], lower[pair[1]] - from[pair[1]]),
          std::min(upper[pair[0]] - from[pair[0]], upper[pair[1]] - from[pair[1]])};
}

/// Interval between the last of the first `good` of kPoints between two ends, and the next point.
Interval last_good(const Interval& ends, std::ptrdiff_t good) {
  const double step = (ends.hi - ends.lo) / kPoints;
  return {ends.lo + step * static_cast<double>(good),
          good == kPoints ? ends.hi : ends.lo + step * static_cast<double>(good + 1)};
}

/// The stretch around 0 over which the logarithms of a pair can be moved together and the objective is
/// at most `most`.
Interval stretch(Problem& problem, const Point& from, const Pair& pair, double most) {
  const Interval within = room(from, pair, problem.space());
  // Each way: from what is good to what is not, as far as is known.
  std::array<Interval, 2> ends{{{0.0, within.lo}, {0.0, within.hi}}};
  for (int round = 0; round < 2; ++round) {
    std::vector<Point> points;
    for (const Interval& end : ends) {
      for (int i = 1; i <= kPoints; ++i) {
        points.push_back(scaled(from, pair, end.lo + (end.hi - end.lo) * i / kPoints));
      }
    }
    const std::vector<Looked> looked = problem.look_at(points);
    const auto is_good = [most](const Looked& one) {
      return one.candidate.feasible() && one.candidate.objective <= most;
    };
    auto first = looked.begin();
    for (Interval& end : ends) {
      const auto bad = std::find_if_not(first, first + kPoints, is_good);
      end = last_good(end, bad - first);
      first += kPoints;
    }
  }
  return {ends[0].lo, ends[1].lo};
}

}  // namespace

SettledGains settle(const TuneOptions& options, const ConstraintContext& context,
                    const Objective& searched, const Objective& all, const Candidate& best) {
  TuneOptions quiet = options;
  quiet.progress = {};
  Problem problem(quiet, context, searched);
  SettledGains settled;
  Point point = problem.space().point_of(best.gains);
  const double objective = problem.look_at(std::span(&point, 1)).front().candidate.objective;
  // Half of what may be given up for each of the two.
  const Interval heading =
      stretch(problem, point, kHeading, (1.0 + 0.5 * kIndifferent) * objective);
  settled.mu = {best.gains.heading.mu * std::exp(heading.lo),
                best.gains.heading.mu * std::exp(heading.hi)};
  point = scaled(point, kHeading, heading.lo);
  const Interval speed = stretch(problem, point, kSpeed, (1.0 + kIndifferent) * objective);
  settled.speed_mu = {best.gains.speed.mu * std::exp(speed.lo),
                      best.gains.speed.mu * std::exp(speed.hi)};
  point = scaled(point, kSpeed, speed.lo);
  Problem on_all(quiet, context, all);
  const Candidate least = on_all.look_at(std::span(&point, 1)).front().candidate;
  settled.gains = least.feasible() ? least.gains : best.gains;
  return settled;
}

Result<std::vector<ActiveConstraint>> active_constraints(const TuneOptions& options,
                                                         const ConstraintContext& context,
                                                         const Objective& objective,
                                                         const Candidate& best) {
  TuneOptions quiet = options;
  quiet.progress = {};
  const Point point = SearchSpace(options).point_of(best.gains);
  // The least objective of a local search with one constraint wider, or with none.
  const auto searched = [&](std::size_t wider) -> Result<double> {
    Problem problem(quiet, context, objective);
    if (wider < problem.tolerated.size()) problem.tolerated[wider] = kWider;
    problem.look_at(std::span(&point, 1));
    problem.simulate_all = true;
    AWMR_RETURN_IF_ERROR(search_locally(problem, problem.nearest.gains, kPriceEvaluations));
    return problem.nearest.objective;
  };
  Problem problem(quiet, context, objective);
  const std::vector<double> residuals = problem.look_at(std::span(&point, 1)).front().residuals;
  std::vector<ActiveConstraint> active;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals[i] > kActive) active.push_back({.name = problem.names()[i]});
  }
  if (active.empty()) return active;
  // A search that had not converged would also improve without a wider limit.
  AWMR_ASSIGN_OR_RETURN(const double without, searched(residuals.size()));
  for (ActiveConstraint& one : active) {
    const auto place = std::ranges::find(problem.names(), one.name) - problem.names().begin();
    AWMR_ASSIGN_OR_RETURN(const double with, searched(static_cast<std::size_t>(place)));
    one.wider_gains = std::max(0.0, (without - with) / without);
  }
  return active;
}

}  // namespace awmr
