#include "awmr/model/vehicle.h"

#include <cmath>

namespace awmr {

double Vehicle::inertia_kgm2() const {
  // Iz = m (a^2 + b^2)/12                                                              [paper (65)]
  return yaw_inertia_kgm2.value_or(mass_kg * (width_m * width_m + length_m * length_m) / 12.0);
}

bool is_vehicle_of_paper(const Vehicle& vehicle) {
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-9 * b; };
  return near(vehicle.mass_kg, 37.0) && near(vehicle.length_m, 1.32) &&
         near(vehicle.width_m, 0.78) && near(vehicle.front_axle_m, 0.35) &&
         near(vehicle.half_track_m, 0.36);
}

}  // namespace awmr
