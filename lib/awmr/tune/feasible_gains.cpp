#include "awmr/tune/feasible_gains.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "awmr/core/random.h"
#include "awmr/tune/nlopt_search.h"
#include "awmr/tune/steering_rate.h"

namespace awmr {
namespace {

/// Number of evaluations of each search.
constexpr int kStartEvaluations = 300;

/// Data of the NLopt callbacks of feasible_gains() and least_relaxed(). The violation of a
/// candidate does not include the constraints named in `relaxed`.
struct Feasibility {
  SearchSpace space;
  const ConstraintContext& context;
  std::span<const std::string> relaxed = {};
  Candidate best = {.violation = std::numeric_limits<double>::infinity()};
  /// Among the gains that meet all other constraints, those that violate the constraints in
  /// `relaxed` least.
  Candidate least = {.violation = std::numeric_limits<double>::infinity()};

  /// Evaluates a point. Returns two largest residuals: of the constraints not in `relaxed`, then of
  /// the constraints in `relaxed`.
  std::pair<double, double> look_at(const Point& point) {
    const Gains<double> gains = with_friction_width(space.gains_at(point), context);
    constexpr double kNone = -std::numeric_limits<double>::infinity();
    std::pair<double, double> largest{kNone, kNone};
    for (const ConstraintReport& c : constraints_of(gains, context)) {
      const bool counts = std::ranges::find(relaxed, c.name) == relaxed.end();
      double& most = counts ? largest.first : largest.second;
      const double r = residual(c);
      if (c.required && (r > most || std::isnan(r))) most = r;
    }
    const auto [of_counted, of_relaxed] = largest;
    if (of_counted < best.violation) best = {.gains = gains, .violation = of_counted};
    if (of_counted <= 0.0 && of_relaxed < least.violation) {
      least = {.gains = gains, .violation = of_relaxed};
    }
    return largest;
  }
};

double feasibility_callback(unsigned dimension, const double* x, double*, void* data) {
  return static_cast<Feasibility*>(data)->look_at(point_at(dimension, x)).first;
}

double relaxed_callback(unsigned dimension, const double* x, double*, void* data) {
  return static_cast<Feasibility*>(data)->look_at(point_at(dimension, x)).second;
}

/// Returns the point with the index `index` from which feasible_gains() starts: 0 is `first`, 1 the
/// middle of the bounds; the others are random.
Point start_point(int index, const SearchSpace& space, std::uint64_t seed,
                  const Gains<double>& first) {
  if (index == 0) return space.point_of(first);
  const Point lo = space.lower_corner();
  const Point hi = space.upper_corner();
  Random random(seed, static_cast<std::uint64_t>(index));
  Point x{};
  for (unsigned i = 0; i < space.dimension(); ++i) {
    x[i] = lo[i] + (hi[i] - lo[i]) * (index == 1 ? 0.5 : random.uniform());
  }
  return x;
}

/// Searches from start_point() 0, 1, ... until `problem.best` meets the constraints that are not in
/// `relaxed`, at most from `starts` starts.
void search_from_starts(Feasibility& problem, std::uint64_t seed, const Gains<double>& first,
                        int starts) {
  for (int i = 0; i < starts && problem.best.violation > 0.0; ++i) {
    Point x = start_point(i, problem.space, seed, first);
    const Optimizer opt = local_optimizer(problem.space, kStartEvaluations);
    nlopt_set_min_objective(opt.get(), feasibility_callback, &problem);
    nlopt_set_stopval(opt.get(), 0.0);
    double value = 0.0;
    nlopt_optimize(opt.get(), x.data(), &value);
  }
}

/// Returns the drawn vehicle whose constraints, except those in `relaxed`, the gains violate most.
/// Precondition: the context has drawn vehicles.
const DrawnVehicle& most_violated(const Feasibility& problem, const Gains<double>& gains) {
  ConstraintContext one = problem.context;
  const DrawnVehicle* most = nullptr;
  double largest = -std::numeric_limits<double>::infinity();
  for (const DrawnVehicle& drawn : problem.context.draws) {
    one.draws.assign(1, drawn);
    Feasibility alone{.space = problem.space, .context = one, .relaxed = problem.relaxed};
    const double violation = alone.look_at(problem.space.point_of(gains)).first;
    if (most && !(violation > largest)) continue;
    most = &drawn;
    largest = violation;
  }
  return *most;
}

/// As search_from_starts(), but examines few of the drawn vehicles at most points, because all
/// vehicles take almost a second for each point if the latency is long. It begins with none of the
/// drawn vehicles. While some drawn vehicle violates a constraint with the gains found, it adds the
/// vehicle with the largest violation and searches again from these gains.
void search_feasible(Feasibility& problem, std::uint64_t seed, const Gains<double>& first,
                     int starts) {
  ConstraintContext some = problem.context;
  some.draws.clear();
  Gains<double> from = first;
  while (some.draws.size() < problem.context.draws.size()) {
    Feasibility few{.space = problem.space, .context = some, .relaxed = problem.relaxed};
    search_from_starts(few, seed, from, starts);
    if (few.best.violation > 0.0) {
      problem.best = few.best;
      return;
    }
    from = few.best.gains;
    problem.look_at(problem.space.point_of(from));
    if (problem.best.violation <= 0.0) return;
    some.draws.push_back(most_violated(problem, from));
  }
  search_from_starts(problem, seed, from, starts);
}

}  // namespace

Candidate feasible_gains(const TuneOptions& options, const ConstraintContext& context,
                         const Gains<double>& first, int starts) {
  Feasibility problem{.space = SearchSpace(options), .context = context};
  search_feasible(problem, options.seed, first, starts);
  return problem.best;
}

std::optional<Gains<double>> least_relaxed(const TuneOptions& options,
                                           const ConstraintContext& context,
                                           const Gains<double>& first,
                                           std::span<const std::string> relaxed) {
  Feasibility problem{.space = SearchSpace(options), .context = context, .relaxed = relaxed};
  search_feasible(problem, options.seed, first, kFewStarts);
  if (problem.best.violation > 0.0) return std::nullopt;
  const Optimizer opt = local_optimizer(problem.space, kStartEvaluations);
  nlopt_set_min_objective(opt.get(), relaxed_callback, &problem);
  nlopt_add_inequality_constraint(opt.get(), feasibility_callback, &problem, 0.0);
  Point x = problem.space.point_of(problem.least.gains);
  double value = 0.0;
  nlopt_optimize(opt.get(), x.data(), &value);
  return problem.least.gains;
}

}  // namespace awmr
