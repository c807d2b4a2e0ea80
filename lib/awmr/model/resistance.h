/// Resistance to motion, an odd power law. Freestanding C++14.
#pragma once

#include "awmr/model/scalar_math.h"

namespace awmr {

/// g(w) = alpha |w|^beta sgn w                                        [paper (47), (63), odd extension]
///
/// Surge: w = u in m/s, g1 dimensionless (force over F_max). Yaw: w = r in rad/s, g3 in m (moment over
/// F_max). alpha > 0 in the unit of g per unit of w^beta; beta >= 0, in [0, 1] for surge in the paper.
///
/// For beta < 1 the slope at rest is infinite. A simulation of step h cannot follow time constants
/// below h, so below `rest_speed` the curve is its chord to the origin; 0 keeps the law exact
/// (simulate/ states how it chooses the value).
template <class T>
struct Resistance {
  T alpha;
  T beta;
  T rest_speed = T(0.0);

  T operator()(const T& speed) const {
    using math::abs;
    using math::pow;
    const T magnitude = abs(speed);
    if (!(magnitude > T(0.0))) return T(0.0);
    if (magnitude < rest_speed) return alpha * pow(rest_speed, beta - T(1.0)) * speed;
    const T value = alpha * pow(magnitude, beta);
    return speed > T(0.0) ? value : -value;
  }
};

}  // namespace awmr
