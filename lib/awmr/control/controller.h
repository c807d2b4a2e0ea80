/// Model, gains and limits of the controller. The same source runs in the simulator (double), on
/// the host in float, and on the AVR.
#pragma once

#include "awmr/control/allocation_limits.h"
#include "awmr/model/gains.h"
#include "awmr/model/resistance.h"

namespace awmr {

/// Model, gains and limits of the controller. G is the type of a resistance g: the formula itself,
/// or a table of it (resistance_table.h). The call g(w) returns the resistance at the speed w.
template <class T, class G = Resistance<T>>
struct Controller {
  G surge;                     ///< surge resistance g1(u), dimensionless, u in m/s; fed forward
  G yaw;                       ///< yaw resistance g3(r), m, r in rad/s; fed forward
  T mass_norm;                 ///< m' of the model, s^2/m, > 0
  T inertia_norm;              ///< I'z of the model, s^2 m, > 0
  Gains<T> gains;              ///< tuned gains
  AllocationLimits<T> limits;  ///< limits of the vehicle
};

/// Gains of the heading law and the speed law, multiplied by model parameters.
template <class T>
struct LawConstants {
  T lambda;         ///< lambda, 1/s
  T heading_rate;   ///< I'z lambda, s m
  T heading_slope;  ///< I'z mu/epsilon, s m
  T heading_limit;  ///< I'z mu, m
  T speed_slope;    ///< m' mu_s/eps_s, s/m
  T speed_limit;    ///< m' mu_s, dimensionless
};

/// Products of model parameters, gains and limits that the laws and the allocation use, computed
/// once. All numbers are of type T, so there is no padding and a check sum can cover the struct.
template <class T>
struct ControlConstants {
  T mass_norm;     ///< m', s^2/m
  T inertia_norm;  ///< I'z, s^2 m
  LawConstants<T> laws;
  AllocationConstants<T> allocation;
};

/// Form of the controller that the laws use: resistances and precomputed constants.
template <class T, class G = Resistance<T>>
struct PreparedController {
  G surge;  ///< g1: surge resistance
  G yaw;    ///< g3: yaw resistance
  ControlConstants<T> constants;
};

template <class T, class G>
PreparedController<T, G> prepared(const Controller<T, G>& c) {
  const HeadingGains<T>& heading = c.gains.heading;
  const SpeedGains<T>& speed = c.gains.speed;
  return {c.surge,
          c.yaw,
          {c.mass_norm,
           c.inertia_norm,
           {heading.lambda, c.inertia_norm * heading.lambda,
            c.inertia_norm * (heading.mu / heading.epsilon), c.inertia_norm * heading.mu,
            c.mass_norm * (speed.mu / speed.epsilon), c.mass_norm * speed.mu},
           prepared(c.limits)}};
}

}  // namespace awmr
