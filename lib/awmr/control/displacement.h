/// Displacement along a heading. Freestanding C++14, and free of names that Arduino defines as macros.
#pragma once

#include "awmr/model/float_math.h"

namespace awmr {

/// dx cos psi + dy sin psi, m: how far a displacement (dx, dy) goes ahead.
AWMR_CALLED inline float displacement_ahead_m(float dx_m, float dy_m, float psi_rad) {
  return dx_m * float_math::cos(psi_rad) + dy_m * float_math::sin(psi_rad);
}
inline double displacement_ahead_m(double dx_m, double dy_m, double psi_rad) {
  return dx_m * ::cos(psi_rad) + dy_m * ::sin(psi_rad);
}

}  // namespace awmr
