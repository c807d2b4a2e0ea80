#include "awmr/model/vehicle.h"

namespace awmr {

double Vehicle::inertia_kgm2() const {
  // Iz = m (a^2 + b^2)/12                                                              [paper (65)]
  return yaw_inertia_kgm2.value_or(mass_kg * (width_m * width_m + length_m * length_m) / 12.0);
}

}  // namespace awmr
