#include "awmr/identify/tables/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "awmr/core/statistics/distributions.h"
#include "awmr/identify/tables/steady_search.h"
#include "awmr/identify/uncertainty/akaike.h"

namespace awmr {
namespace {

/// Minimum of the sum of squared residuals over all coordinates except `held`, which is fixed at
/// `value`. The search starts at `initial_guess`. Infinite if the search fails.
double profile_cost(const SteadyProblem& problem, const TransformedParameters& initial_guess,
                    TransformedParameter held, double value) {
  TransformedParameters from = initial_guess;
  from[at(held)] = value;
  SteadySearch search(problem, from, held);
  search.solve();
  if (!search.summary().IsSolutionUsable()) return std::numeric_limits<double>::infinity();
  const std::optional<Eigen::VectorXd> e = search.residuals();
  return e ? e->squaredNorm() : std::numeric_limits<double>::infinity();
}

/// A point of a profile: a value x of the coordinate, with zeta(x) (see Profile below).
struct Place {
  double x = 0.0;
  double zeta = 0.0;
};

/// Computes zeta(x) = sqrt(profile_cost(x) - minimum)/s, with the residual standard deviation s.
/// For a linear model with the optimum x0, zeta(x) = |x - x0|/std_error, so that a secant method
/// converges in few steps.
struct Profile {
  const SteadyProblem& problem;
  const SteadyFit& fit;
  TransformedParameter c;

  Place at(double x) const {
    const double minimum = fit.residuals.squaredNorm();
    const double cost = profile_cost(problem, fit.theta, c, x);
    return {x, std::sqrt(std::max(0.0, cost - minimum)) / fit.residual_std};
  }
};

/// Finds x with zeta(x) = t, between the points `near`, where zeta < t, and `far`, where zeta > t.
double crossing(const Profile& profile, Place near, Place far, double t, double std_error) {
  for (int i = 0; i < 60 && std::abs(far.x - near.x) > 1e-9 * std_error; ++i) {
    // Regula falsi. The next point keeps a distance of at least 2 % of the bracket from its ends,
    // so that the bracket shrinks in every step.
    const double share = std::isfinite(far.zeta) ? (t - near.zeta) / (far.zeta - near.zeta) : 0.5;
    const double x = near.x + std::clamp(share, 0.02, 0.98) * (far.x - near.x);
    const Place middle = profile.at(x);
    if (std::abs(middle.zeta - t) < 1e-8) return x;
    (middle.zeta < t ? near : far) = middle;
  }
  return 0.5 * (near.x + far.x);
}

/// The upper (sign 1) or lower (sign -1) end of the interval, where zeta = t. Returns the bound of
/// the coordinate if zeta is below t up to the bound.
double end_of(const Profile& profile, double sign, double t) {
  const Interval bounds = bounds_of(profile.problem, profile.c);
  const double std_error = *profile.fit.std_error(profile.c);
  const double bound = sign > 0.0 ? bounds.hi : bounds.lo;
  const auto inside = [&](double x) {
    return sign > 0.0 ? std::min(x, bound) : std::max(x, bound);
  };
  Place near{profile.fit[profile.c], 0.0};
  Place far = profile.at(inside(near.x + sign * t * std_error));
  for (int i = 0; i < 40 && far.zeta < t; ++i) {
    if (far.x == bound) return bound;
    near = far;
    far = profile.at(inside(far.x + sign * t * std_error * std::pow(1.5, i)));
  }
  return crossing(profile, near, far, t, std_error);
}

}  // namespace

Interval profile_interval(const SteadyProblem& problem, const SteadyFit& fit,
                          TransformedParameter c) {
  const Profile profile{problem, fit, c};
  const double t = t_quantile_95(fit.degrees_of_freedom);
  return {end_of(profile, -1.0, t), end_of(profile, 1.0, t)};
}

std::optional<double> aicc(const SteadyFit& fit) {
  const double held_exponent = fit.held_by_bound(TransformedParameter::kBeta) ? 1.0 : 0.0;
  return aicc(fit.residuals.squaredNorm(), static_cast<double>(fit.residuals.size()),
              static_cast<double>(fit.free.size()) + held_exponent);
}

}  // namespace awmr
