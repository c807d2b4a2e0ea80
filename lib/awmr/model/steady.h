/// What a resistance says of steady motion and of stopping.
#pragma once

#include <optional>

#include "awmr/model/resistance.h"

namespace awmr {

/// The w > 0 with g(w) = force: steady speed in m/s under tau_speed, or yaw rate in rad/s under
/// tau_turn. None where the force does not overcome c, or the curve never reaches it.
std::optional<double> steady_rate(const Resistance<double>& law, double force);

/// Time from motors-off at speed_mps > 0 to rest, s:
///   t_a = m' int_0^u dw / g(w) = m' u^(1-b) / ((1-b) a) for a power law         [paper (59),
///   solved]
/// None where the vehicle never stops: c = 0 and b >= 1.
std::optional<double> stop_time_s(const Resistance<double>& law, double mass_norm,
                                  double speed_mps);

/// Speed below which a simulation of step h takes the resistance as its chord
/// (Resistance::rest_speed). On the chord the speed decays at g(w)/(w inertia); Runge-Kutta is
/// stable to rate h < 2.78 and monotone to about 1, so w is where that rate is 1/h:
///   w = (alpha h / inertia)^(1/(1 - beta))   for a power law of beta < 1, by iteration of
///   w = g(w) h / inertia                     with a Coulomb part;   0, no such speed, otherwise.
double rest_speed(const Resistance<double>& law, double inertia, double step_s);

}  // namespace awmr
