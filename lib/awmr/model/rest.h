/// A plant that a simulation can bring to rest.
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/steady.h"

namespace awmr {

/// The plant whose resistances have the chord at rest that Runge-Kutta steps of step_s seconds
/// need: see rest_speed().
inline Plant<double> resolved_at_rest(Plant<double> plant, double step_s) {
  plant.surge.rest_speed = rest_speed(plant.surge, plant.mass_norm, step_s);
  plant.yaw.rest_speed = rest_speed(plant.yaw, plant.inertia_norm, step_s);
  return plant;
}

}  // namespace awmr
