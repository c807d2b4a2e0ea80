/// Random robots, from a toy to a tractor, for properties that hold for all of them.
#pragma once

#include <rapidcheck.h>

#include <cmath>

#include "awmr/core/units.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {

inline double between(double lo, double hi) {
  return lo + (hi - lo) * *rc::gen::inRange(0, 1000001) / 1e6;
}

/// Draws a number log-uniformly between two values, both > 0.
inline double ratio_between(double lo, double hi) {
  return lo * std::pow(hi / lo, *rc::gen::inRange(0, 1000001) / 1e6);
}

/// Draws a plant in the range from a toy to a tractor. `beyond` 10 extends the range of each
/// parameter tenfold at both ends; 1: not.
inline Plant<double> any_plant(double beyond) {
  return {.surge = {.alpha = ratio_between(0.1 / beyond, 5.0 * beyond),
                    .beta = between(0.0, 1.0 + 0.3 * beyond),
                    .quadratic = between(0.0, 0.1 * beyond)},
          .yaw = {.alpha = ratio_between(0.05 / beyond, 2.0 * beyond),
                  .beta = between(0.0, 4.0 + 0.4 * beyond)},
          .sway_alpha = ratio_between(0.5 / beyond, 12.0 * beyond),
          .mass_norm = ratio_between(0.02 / beyond, 2.0 * beyond),
          .inertia_norm = ratio_between(0.005 / beyond, 1.0 * beyond),
          .front_axle_m = 0.35,
          .half_track_m = 0.36,
          .steering_max_rad = radians(between(5.0, 60.0)),
          .steering_max_rate_radps = radians(ratio_between(30.0 / beyond, 600.0 * beyond)),
          .steering_time_constant_s = ratio_between(0.01 / beyond, 0.5 * beyond)};
}

/// Draws a plant by any_plant() and returns its power-law model, as read from a model.json.
inline Model any_model(double beyond) {
  const Plant<double> plant = any_plant(beyond);
  Model model;
  model.vehicle = paper_vehicle();
  model.vehicle.steering_max_deg = plant.steering_max_rad / radians(1.0);
  model.vehicle.steering_max_rate_degps = plant.steering_max_rate_radps / radians(1.0);
  model.vehicle.steering_time_constant_s = plant.steering_time_constant_s;
  model[ParameterId::kSurgeAlpha].value = plant.surge.alpha;
  model[ParameterId::kSurgeBeta].value = plant.surge.beta;
  model[ParameterId::kYawAlpha].value = plant.yaw.alpha;
  model[ParameterId::kYawBeta].value = plant.yaw.beta;
  model[ParameterId::kSwayAlpha].value = plant.sway_alpha;
  model[ParameterId::kMassNorm].value = plant.mass_norm;
  model[ParameterId::kInertiaNorm].value = plant.inertia_norm;
  model[ParameterId::kSteeringTimeConstant].value = plant.steering_time_constant_s;
  return model;
}

/// Draws gains from slow to aggressive; `beyond` as for any_plant().
inline Gains<double> any_gains(double beyond) {
  return {.heading = {.lambda = ratio_between(0.5 / beyond, 15.0 * beyond),
                      .mu = ratio_between(1.0 / beyond, 200.0 * beyond),
                      .epsilon = ratio_between(0.1 / beyond, 50.0 * beyond)},
          .speed = {.mu = ratio_between(0.5 / beyond, 100.0 * beyond),
                    .epsilon = ratio_between(0.05 / beyond, 10.0 * beyond)}};
}

}  // namespace awmr::testing
