/// Displacement along a heading. Avoids names that Arduino defines as macros.
#pragma once

#include "awmr/model/quick_sin.h"

namespace awmr {

/// Component of a displacement (dx, dy) along a heading, m:
///   ahead = dx cos psi + dy sin psi
AWMR_CALLED inline float displacement_ahead_m(float dx_m, float dy_m, float psi_rad) {
  return dx_m * math::quick_cos(psi_rad) + dy_m * math::quick_sin(psi_rad);
}
inline double displacement_ahead_m(double dx_m, double dy_m, double psi_rad) {
  return dx_m * ::cos(psi_rad) + dy_m * ::sin(psi_rad);
}

/// Component of a displacement (dx, dy) to the left of a heading, m:
///   left = dy cos psi - dx sin psi
inline float displacement_left_m(float dx_m, float dy_m, float psi_rad) {
  return displacement_ahead_m(dy_m, -dx_m, psi_rad);
}

}  // namespace awmr
