/// Integrator independent of the simulator: Boost.odeint's Dormand-Prince 5(4) with step-size
/// control.
#pragma once

#include <array>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/generation/make_controlled.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "awmr/model/state.h"

namespace awmr::testing {

/// State at end_s of d(state)/dt = rates(state) from `start`, with tolerances far below those of
/// the simulator's tests.
template <class Rates>
State<double> integrate_reference(const Rates& rates, const State<double>& start, double end_s) {
  namespace odeint = boost::numeric::odeint;
  using Values = std::array<double, 7>;
  const auto state_of = [](const Values& v) {
    return State<double>{v[0], v[1], v[2], v[3], v[4], v[5], v[6]};
  };
  const auto values_of = [](const State<double>& s) {
    return Values{s.x_m, s.y_m, s.psi_rad, s.u_mps, s.v_mps, s.r_radps, s.steering_rad};
  };
  constexpr double kAbsoluteTolerance = 1e-12;
  constexpr double kRelativeTolerance = 1e-11;
  Values values = values_of(start);
  odeint::integrate_adaptive(
      odeint::make_controlled<odeint::runge_kutta_dopri5<Values>>(kAbsoluteTolerance,
                                                                  kRelativeTolerance),
      [&](const Values& v, Values& d, double) { d = values_of(rates(state_of(v))); }, values, 0.0,
      end_s, 1e-4 * end_s);
  return state_of(values);
}

}  // namespace awmr::testing
