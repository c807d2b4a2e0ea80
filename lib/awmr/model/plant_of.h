/// Converts identified parameters and vehicle data to the Plant of the equations of motion. A
/// template on the scalar.
#pragma once

#include <array>

#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"
#include "awmr/model/parameters.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// A value for each parameter, indexed by ParameterId, in the units of parameter_table().
template <class T>
using ParameterValues = std::array<T, kParameterCount>;

/// The plant with these parameter values and the vehicle's geometry, drive and steering limits. It
/// has no tyre scrub: Plant::yaw_scrub_m is 0.
template <class T>
Plant<T> plant_of(const Vehicle& vehicle, const ParameterValues<T>& values) {
  const auto value = [&values](ParameterId id) { return values[static_cast<std::size_t>(id)]; };
  return {.surge = {.alpha = value(ParameterId::kSurgeAlpha),
                    .beta = value(ParameterId::kSurgeBeta),
                    .coulomb = value(ParameterId::kSurgeCoulomb),
                    .quadratic = value(ParameterId::kSurgeQuadratic)},
          .yaw = {.alpha = value(ParameterId::kYawAlpha),
                  .beta = value(ParameterId::kYawBeta),
                  .coulomb = value(ParameterId::kYawCoulomb),
                  .quadratic = value(ParameterId::kYawQuadratic)},
          .sway_alpha = value(ParameterId::kSwayAlpha),
          .mass_norm = value(ParameterId::kMassNorm),
          .inertia_norm = value(ParameterId::kInertiaNorm),
          .front_axle_m = T(vehicle.front_axle_m),
          .half_track_m = T(vehicle.half_track_m),
          .steering_max_rad = T(radians(vehicle.steering_max_deg)),
          .steering_max_rate_radps = T(radians(vehicle.steering_max_rate_degps)),
          .steering_time_constant_s = value(ParameterId::kSteeringTimeConstant),
          .wheel_dead_zone = value(ParameterId::kWheelDeadZone),
          .back_emf_s_per_m = value(ParameterId::kBackEmf),
          .rear_driven = T(vehicle.drive == Drive::kFrontWheel ? 0.0 : 1.0)};
}

}  // namespace awmr
