// The paper's printed model (Appendix B, Tables 2 and 3), as returned by `identify`.
#pragma once

#include "support/paper_vehicle.h"

namespace awmr::testing {

inline Estimate given(double value) {
  Estimate e;
  e.value = value;
  e.method = "paper";
  return e;
}

inline Model paper_model() {
  Model m;
  m.vehicle = paper_vehicle();
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
