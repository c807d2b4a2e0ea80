#include "awmr/model/steady.h"

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>

namespace awmr {
namespace {

bool is_power(const Resistance<double>& law) { return law.coulomb == 0.0 && law.quadratic == 0.0; }

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<double> steady_rate(const Resistance<double>& law, double force) {
  // force = alpha w^beta  =>  w = (force/alpha)^(1/beta)               [paper (46)-(47), (62)-(63)]
  if (is_power(law)) {
    if (!(force > 0.0) || !(law.beta > 0.0)) return std::nullopt;
    return finite(std::pow(force / law.alpha, 1.0 / law.beta));
  }
  if (!(force > law.coulomb) || !std::isfinite(force)) return std::nullopt;
  constexpr double kFastest = 1e9;
  constexpr double kSlowest = 1e-300;
  double hi = 1.0;
  while (law.at(hi) < force && hi <= kFastest) hi *= 2.0;
  if (!(hi <= kFastest && law.at(hi) >= force)) return std::nullopt;
  // A curve that jumps at rest by more than c (beta = 0) never comes down to a force in between.
  double lo = hi;
  while (law.at(lo) > force && lo >= kSlowest) lo /= 2.0;
  if (!(law.at(lo) <= force)) return std::nullopt;
  // g rises, so halving the bracket finds the root to the last bit.
  for (int i = 0; i < 200 && std::nextafter(lo, hi) < hi; ++i) {
    const double middle = 0.5 * (lo + hi);
    (law.at(middle) < force ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
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

double rest_speed(const Resistance<double>& law, double inertia, double step_s) {
  if (law.coulomb > 0.0) {
    double w = law.coulomb * step_s / inertia;
    // Near the solution a round shrinks the error by the factor w g'(w)/g(w), which is below
    // beta <= 1 for the families there are: 60 rounds are ample.
    for (int i = 0; i < 60; ++i) w = law.at(w) * step_s / inertia;
    return w;
  }
  if (law.beta >= 1.0) return 0.0;
  return std::pow(law.alpha * step_s / inertia, 1.0 / (1.0 - law.beta));
}

}  // namespace awmr
