/// Default robot of the tests: configs/paper/vehicle.json with parameters from the paper's Tables 2
/// and 3. A test that needs another value of a field copies this vehicle and sets the field.
#pragma once

#include "awmr/control/controller.h"
#include "awmr/model/model.h"
#include "awmr/model/plant_of.h"
#include "awmr/model/vehicle_file.h"

namespace awmr::testing {

/// configs/paper/vehicle.json; throws if it cannot be read.
inline const Vehicle& paper_vehicle() {
  static const Vehicle kVehicle =
      read_vehicle(AWMR_SOURCE_DIR "/configs/paper/vehicle.json").value();
  return kVehicle;
}

/// Parameter values by ParameterId: a1, b1, a3, b3 by log-linear fits of the tables as printed, m'
/// as printed, and I'z = m' Iz/m.
template <class T>
ParameterValues<T> paper_values_of() {
  ParameterValues<T> values;
  values.fill(T(0.0));
  const auto set = [&values](ParameterId id, double value) {
    values[static_cast<std::size_t>(id)] = T(value);
  };
  set(ParameterId::kSurgeAlpha, 1.3157);
  set(ParameterId::kSurgeBeta, 0.8841);
  set(ParameterId::kYawAlpha, 0.3028);
  set(ParameterId::kYawBeta, 0.8250);
  set(ParameterId::kSwayAlpha, 3.0);
  set(ParameterId::kMassNorm, 0.0768);
  set(ParameterId::kInertiaNorm, 0.01212);
  set(ParameterId::kSteeringTimeConstant, 0.02);
  return values;
}

template <class T>
Plant<T> paper_plant_of() {
  return plant_of<T>(paper_vehicle(), paper_values_of<T>());
}

inline Plant<double> paper_plant() { return paper_plant_of<double>(); }

template <class T>
Controller<T> paper_controller_of() {
  const Plant<T> plant = paper_plant_of<T>();
  const Interval& force = paper_vehicle().wheel_force;
  return {.surge = plant.surge,
          .yaw = plant.yaw,
          .mass_norm = plant.mass_norm,
          .inertia_norm = plant.inertia_norm,
          .gains = {{T(3.0), T(50.0), T(12.0)}, {T(5.0), T(1.2)}},
          .limits = {.front_axle_m = plant.front_axle_m,
                     .half_track_m = plant.half_track_m,
                     .force_min = T(force.lo),
                     .force_max = T(force.hi),
                     .steering_max_rad = plant.steering_max_rad,
                     .steering_max_tan_half = tan_half(plant.steering_max_rad),
                     .split = CombinedSplit::kRedistribute}};
}

/// Model with these values, without uncertainty.
inline Model fitted_paper_model() {
  Model model;
  model.vehicle = paper_vehicle();
  const ParameterValues<double> values = paper_values_of<double>();
  for (const ParameterInfo& parameter : parameter_table()) {
    if (!parameter.term) model[parameter.id].value = values[static_cast<std::size_t>(parameter.id)];
  }
  return model;
}

}  // namespace awmr::testing
