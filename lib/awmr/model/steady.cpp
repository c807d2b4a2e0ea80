#include "awmr/model/steady.h"

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>

namespace awmr {
namespace {

bool is_power(const Resistance<double>& law) { return law.coulomb == 0.0 && law.quadratic == 0.0; }

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Solves alpha w^beta + v w + q w^2 = excess for w, with v = `viscous`, by Newton's method on
///   h(s) = ln((alpha e^(s beta) + v e^s + q e^(2 s))/excess),   w = e^s
/// h is increasing and convex, because it is the logarithm of a sum of exponentials. So iterations
/// that start above the root fall monotonically to it. They end when rounding would reverse a step.
std::optional<double> rate_above_coulomb(const Resistance<double>& law, double excess,
                                         double viscous) {
  constexpr double kFastest = 1e9;
  constexpr double kSlowest = 1e-300;
  constexpr int kMaxSteps = 200;
  if (!(excess > 0.0) || !std::isfinite(excess)) return std::nullopt;
  // Start above the root: at the smallest of the speeds at which one term alone equals `excess`.
  double w = std::min({std::pow(excess / law.alpha, 1.0 / law.beta),
                       std::sqrt(excess / law.quadratic), excess / viscous});
  for (int i = 0; i < kMaxSteps && w > kSlowest && w <= kFastest; ++i) {
    const double power = law.alpha * std::pow(w, law.beta);
    const double square = law.quadratic * w * w;
    const double linear = viscous * w;
    const double h = std::log1p((power + square + linear - excess) / excess);
    const double slope = (law.beta * power + 2.0 * square + linear) / (power + square + linear);
    const double next = w * std::exp(-h / slope);
    if (!(next < w)) return finite(next);
    w = next;
  }
  // No solution: the speed would exceed that of any vehicle; or beta = 0, and g jumps at rest by
  // more than the force.
  return std::nullopt;
}

}  // namespace

std::optional<double> steady_rate(const Resistance<double>& law, double force, double viscous) {
  // force = alpha w^beta  =>  w = (force/alpha)^(1/beta)               [paper (46)-(47), (62)-(63)]
  if (is_power(law) && !(viscous > 0.0)) {
    if (!(force > 0.0) || !(law.beta > 0.0)) return std::nullopt;
    return finite(std::pow(force / law.alpha, 1.0 / law.beta));
  }
  return rate_above_coulomb(law, force - law.coulomb, viscous);
}

std::optional<double> stop_time_s(const Resistance<double>& law, double mass_norm,
                                  double speed_mps) {
  if (is_power(law)) {
    const double rest = 1.0 - law.beta;
    if (!(rest > 0.0)) return std::nullopt;
    return finite(mass_norm * std::pow(speed_mps, rest) / (rest * law.alpha));
  }
  if (!(law.coulomb > 0.0) && law.beta >= 1.0) return std::nullopt;
  boost::math::quadrature::tanh_sinh<double> quadrature;
  return finite(mass_norm *
                quadrature.integrate([&law](double w) { return 1.0 / law.at(w); }, 0.0, speed_mps));
}

}  // namespace awmr
