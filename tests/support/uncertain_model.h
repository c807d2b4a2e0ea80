// Model of the paper's vehicle with a covariance of four fitted parameters.
#pragma once

#include "awmr/core/units.h"
#include "awmr/simulate/scenario.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {

inline Model uncertain_model() {
  Model model = fitted_paper_model();
  model.covariance.parameters = {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta,
                                 ParameterId::kYawAlpha, ParameterId::kMassNorm};
  // s.e. 0.02, 0.016, 0.01, 0.008; correlations a1 b1 0.5, b1 m' -0.9,
  // a1 m' -0.45: positive definite, 1 + 2 (0.5)(0.9)(0.45) - 0.25 - 0.81 - 0.2025 > 0.
  model.covariance.matrix = {{4.0e-4, 1.6e-4, 0.0, -7.2e-5},
                             {1.6e-4, 2.56e-4, 0.0, -1.152e-4},
                             {0.0, 0.0, 1.0e-4, 0.0},
                             {-7.2e-5, -1.152e-4, 0.0, 6.4e-5}};
  return model;
}

/// A scenario with one short heading step, in which every heading metric has a value.
inline Scenario short_heading(const std::string& name = "step") {
  return {.name = name,
          .duration_s = 3.0,
          .initial = {.x_m = 0.0,
                      .y_m = 0.0,
                      .psi_rad = 0.0,
                      .u_mps = 1.0,
                      .v_mps = 0.0,
                      .r_radps = 0.0,
                      .steering_rad = 0.0},
          .speed_mps = 1.0,
          .guidance = HeadingSteps{{{0.0, radians(10.0)}}}};
}

inline Scenario short_open_loop() {
  return {.name = "circle",
          .duration_s = 1.0,
          .initial = {},
          .speed_mps = 0.0,
          .guidance = OpenLoop{2.0, 0.4}};
}

}  // namespace awmr::testing
