#include "awmr/model/model.h"

#include <fmt/format.h>

#include "awmr/core/units.h"

namespace awmr {

double max_wheel_force_n(double mass_kg, double mass_norm) { return mass_kg / mass_norm; }

Model::Model() {
  for (const ParameterInfo& parameter : parameter_table()) {
    if (parameter.term) (*this)[parameter.id] = {0.0, {}, {}, Source::kGiven, "not in the family"};
  }
}

Result<Plant<double>> Model::plant(const std::string& file) const {
  std::vector<Fault> faults;
  for (const ParameterInfo& parameter : parameter_table()) {
    if ((*this)[parameter.id].value) continue;
    faults.push_back(
        {fmt::format("{}:{}", file, parameter.pointer),
         fmt::format("no value for {} ({}, {}), which this needs; identify again with {}",
                     parameter.name, parameter.symbol, parameter.meaning, parameter.trial)});
  }
  if (!faults.empty()) return input_errors(std::move(faults));

  const auto value = [this](ParameterId id) { return *(*this)[id].value; };
  return Plant<double>{.surge = {.alpha = value(ParameterId::kSurgeAlpha),
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
                       .front_axle_m = vehicle.front_axle_m,
                       .half_track_m = vehicle.half_track_m,
                       .steering_max_rad = radians(vehicle.steering_max_deg),
                       .steering_max_rate_radps = radians(vehicle.steering_max_rate_degps),
                       .steering_time_constant_s = value(ParameterId::kSteeringTimeConstant),
                       .wheel_dead_zone = value(ParameterId::kWheelDeadZone)};
}

}  // namespace awmr
