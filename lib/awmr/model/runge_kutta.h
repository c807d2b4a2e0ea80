/// The classical Runge-Kutta method on the 3-DOF vehicle. Templates on the scalar.
#pragma once

#include "awmr/model/dynamics.h"

namespace awmr {

/// s + h d: the state s after h seconds at the constant rates d.
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

/// The state one step of h seconds later, by the classical fourth-order method:
///   k1 = rates(s),   k2 = rates(s + h/2 k1),   k3 = rates(s + h/2 k2),   k4 = rates(s + h k3)
///   s + h/6 (k1 + 2 k2 + 2 k3 + k4)
/// Its error per step is of order h^5 for smooth rates.
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

/// rk4_step() as a function object: an integrator that other functions take as an argument.
struct RungeKutta4 {
  template <class T, class Rates>
  State<T> operator()(const State<T>& from, const T& h, const Rates& rates) const {
    return rk4_step(from, h, rates);
  }
};

}  // namespace awmr
