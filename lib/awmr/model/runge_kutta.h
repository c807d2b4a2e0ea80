/// The classical Runge-Kutta method on the 3-DOF vehicle. Templates on the scalar.
#pragma once

#include "awmr/model/dynamics.h"

namespace awmr {

/// s + h d
template <class T>
State<T> moved(const State<T>& s, const State<T>& d, const T& h) {
  return {s.x_m + h * d.x_m,
          s.y_m + h * d.y_m,
          s.psi_rad + h * d.psi_rad,
          s.u_mps + h * d.u_mps,
          s.v_mps + h * d.v_mps,
          s.r_radps + h * d.r_radps,
          s.steering_rad + h * d.steering_rad};
}

/// One step of h seconds along rates(state): local error of order h^5 where they are smooth.
template <class T, class Rates>
State<T> rk4_step(const State<T>& s, const T& h, const Rates& rates) {
  const State<T> k1 = rates(s);
  const State<T> k2 = rates(moved(s, k1, T(h / 2.0)));
  const State<T> k3 = rates(moved(s, k2, T(h / 2.0)));
  const State<T> k4 = rates(moved(s, k3, h));
  State<T> next = moved(s, k1, T(h / 6.0));
  next = moved(next, k2, T(h / 3.0));
  next = moved(next, k3, T(h / 3.0));
  return moved(next, k4, T(h / 6.0));
}

}  // namespace awmr
