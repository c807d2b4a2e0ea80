/// The paper's vehicle over any scalar.
#pragma once

#include "awmr/control/controller.h"
#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"

namespace awmr::testing {

template <class T>
Plant<T> paper_plant_of() {
  return {.surge = {T(1.3157), T(0.8841)},
          .yaw = {T(0.3028), T(0.8250)},
          .sway_alpha = T(3.0),
          .mass_norm = T(0.0768),
          .inertia_norm = T(0.01212),
          .front_axle_m = T(0.35),
          .half_track_m = T(0.36),
          .steering_max_rad = T(radians(20.0)),
          .steering_max_rate_radps = T(radians(300.0)),
          .steering_time_constant_s = T(0.02)};
}

template <class T>
Controller<T> paper_controller_of() {
  const Plant<T> plant = paper_plant_of<T>();
  return {.surge = plant.surge,
          .yaw = plant.yaw,
          .mass_norm = plant.mass_norm,
          .inertia_norm = plant.inertia_norm,
          .gains = {{T(3.0), T(50.0), T(12.0)}, {T(5.0), T(1.2)}},
          .limits = {.front_axle_m = plant.front_axle_m,
                     .half_track_m = plant.half_track_m,
                     .force_min = T(-1.0),
                     .force_max = T(1.0),
                     .steering_max_rad = plant.steering_max_rad,
                     .steering_max_tan_half = tan_half(plant.steering_max_rad),
                     .split = CombinedSplit::kRedistribute}};
}

}  // namespace awmr::testing
