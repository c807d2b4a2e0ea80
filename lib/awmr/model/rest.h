/// Replaces the resistances near rest by chords through the origin, so that a simulation can
/// integrate a plant until it stops.
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/steady.h"

namespace awmr {

/// The value of a scalar as a plain number. Types that carry derivatives (ceres::Jet) have
/// overloads of this function.
inline double value_of(double x) { return x; }

/// The same law with coefficients of type double; derivatives that T carries are dropped.
template <class T>
Resistance<double> value_of(const Resistance<T>& law) {
  return {value_of(law.alpha), value_of(law.beta), value_of(law.rest_speed), value_of(law.coulomb),
          value_of(law.quadratic)};
}

/// The plant with the chords of g1 and g3 (Resistance::rest_speed) that Runge-Kutta steps of step_s
/// seconds need; see rest_speed(). The speeds below which the chords apply have no derivatives,
/// because they depend on the length of the steps, not on the motion.
template <class T>
Plant<T> resolved_at_rest(Plant<T> plant, double step_s) {
  plant.surge.rest_speed = T(rest_speed(value_of(plant.surge), value_of(plant.mass_norm), step_s));
  plant.yaw.rest_speed = T(rest_speed(value_of(plant.yaw), value_of(plant.inertia_norm), step_s));
  return plant;
}

}  // namespace awmr
