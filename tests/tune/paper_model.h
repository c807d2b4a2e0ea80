// The paper's printed model (Appendix B, Tables 2 and 3), as `identify` would hand it over.
#pragma once

#include "awmr/model/model.h"

namespace awmr::testing {

inline Estimate given(double value) {
  Estimate e;
  e.value = value;
  e.method = "paper";
  return e;
}

inline Model paper_model() {
  Model m;
  m.vehicle = {.name = "paper",
               .mass_kg = 37.0,
               .length_m = 1.32,
               .width_m = 0.78,
               .front_axle_m = 0.35,
               .half_track_m = 0.36,
               .wheel_force = {-1.0, 1.0},
               .steering_max_deg = 20.0,
               .steering_max_rate_degps = 300.0,
               .steering_time_constant_s = 0.02,
               .sample_time_s = 0.01,
               .yaw_inertia_kgm2 = 5.841,
               .sway_alpha = 3.0};
  m[ParameterId::kSurgeAlpha] = given(1.3268);
  m[ParameterId::kSurgeBeta] = given(0.8933);
  m[ParameterId::kYawAlpha] = given(0.3028);
  m[ParameterId::kYawBeta] = given(0.8250);
  m[ParameterId::kSwayAlpha] = given(3.0);
  m[ParameterId::kMassNorm] = given(0.0768);
  m[ParameterId::kInertiaNorm] = given(0.0128);
  m[ParameterId::kSteeringTimeConstant] = given(0.02);
  return m;
}

}  // namespace awmr::testing
