// A model of the paper's vehicle as identification gives it from Tables 2 and 3.
#pragma once

#include "awmr/model/model.h"

namespace awmr::testing {

inline Model fitted_paper_model() {
  Model model;
  model.vehicle = {.name = "paper",
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
  const auto set = [&model](ParameterId id, double value) { model[id].value = value; };
  set(ParameterId::kSurgeAlpha, 1.3157);
  set(ParameterId::kSurgeBeta, 0.8841);
  set(ParameterId::kYawAlpha, 0.3028);
  set(ParameterId::kYawBeta, 0.8250);
  set(ParameterId::kSwayAlpha, 3.0);
  set(ParameterId::kMassNorm, 0.0768);
  set(ParameterId::kInertiaNorm, 0.01212);
  set(ParameterId::kSteeringTimeConstant, 0.02);
  return model;
}

/// Four of the printed rows: tau_speed and m/s, tau_turn and rad/s, m/s and s.
inline void add_paper_trials(Model& model) {
  model.record.trials = {{TrialKind::kSurge, "surge.csv", 3, 0.2, 0.12, {}},
                  {TrialKind::kSurge, "surge.csv", 12, 2.0, 1.66, {}},
                  {TrialKind::kTurning, "turning.csv", 4, 0.064, 0.15, {}},
                  {TrialKind::kCoastdown, "coastdown.csv", 4, 1.66, 0.573, {}}};
}

}  // namespace awmr::testing
