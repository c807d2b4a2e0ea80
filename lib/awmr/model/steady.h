/// Steady motion and stopping time for a resistance law.
#pragma once

#include <cmath>
#include <optional>

#include "awmr/model/resistance.h"

namespace awmr {

/// The steady speed w > 0, at which the resistance equals the driving force: g(w) = force. For g1,
/// `force` is tau_speed and w is in m/s; for g3, it is tau_turn in m, and w is a yaw rate in rad/s.
/// `viscous` >= 0 adds a linear term such as back-EMF: g(w) + viscous w = force, with viscous = 4
/// k_e straight ahead with four motors. None if the force does not exceed the Coulomb friction c,
/// or if no finite w exists, as for a power law with beta = 0.
std::optional<double> steady_rate(const Resistance<double>& law, double force,
                                  double viscous = 0.0);

/// Time from motors off at speed_mps = u > 0 to rest, s:
///   t_a = m' int_0^u dw/g(w)
///       = m' u^(1-beta) / ((1-beta) alpha)   for a power law                     [paper (55)-(59)]
/// None if the vehicle never stops but approaches rest asymptotically (c = 0 and beta >= 1).
std::optional<double> stop_time_s(const Resistance<double>& law, double mass_norm,
                                  double speed_mps);

/// Time constant, s, with which a resistance g slows the motion at the speed w > 0: inertia w/g(w).
/// The inertia is the mass m' for surge, and the yaw inertia I'z for yaw.
inline double relaxation_time_s(const Resistance<double>& law, double inertia, double w) {
  return inertia * w / law.at(w);
}

/// Slope of a resistance g at the speed or yaw rate w > 0:
///   g'(w) = alpha beta w^(beta - 1) + 2 q w
inline double slope(const Resistance<double>& g, double w) {
  return g.alpha * g.beta * std::pow(w, g.beta - 1.0) + 2.0 * g.quadratic * w;
}

/// The speed, m/s or rad/s, below which a simulation with steps of h = step_s seconds replaces the
/// resistance by its chord (Resistance::rest_speed). `inertia` is m' for surge and I'z for yaw.
///
/// On the chord from the origin to the curve at w, the speed decays at the rate g(w)/(w inertia).
/// The Runge-Kutta method is stable if the rate times h is below 2.78, and its solution is monotone
/// if the product is below about 1. So w is chosen for a rate of 1/h:
///   w = g(w) h/inertia                        with Coulomb friction: solved by iteration
///   w = (alpha h/inertia)^(1/(1 - beta))      for a power law of beta < 1
///   w = 0: the law needs no chord             in other cases
double rest_speed(const Resistance<double>& law, double inertia, double step_s);

}  // namespace awmr
