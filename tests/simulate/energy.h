/// Kinetic energy for the property tests of the simulator.
#pragma once

#include "awmr/model/dynamics.h"

namespace awmr::testing {

/// Kinetic energy of the vehicle, over F_max, m.
inline double kinetic(const Plant<double>& p, const State<double>& s) {
  return 0.5 * p.mass_norm * (s.u_mps * s.u_mps + s.v_mps * s.v_mps) +
         0.5 * p.inertia_norm * s.r_radps * s.r_radps;
}

}  // namespace awmr::testing
