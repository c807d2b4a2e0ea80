/// The paper's vehicle, for tests of the simulator.
#pragma once

#include "awmr/core/units.h"
#include "awmr/simulate/simulate.h"

namespace awmr::testing {

inline Plant<double> paper_plant() {
  return {.surge = {1.3157, 0.8841},
          .yaw = {0.3028, 0.8250},
          .sway_alpha = 3.0,
          .mass_norm = 0.0768,
          .inertia_norm = 0.01212,
          .front_axle_m = 0.35,
          .half_track_m = 0.36,
          .steering_max_rad = radians(20.0),
          .steering_max_rate_radps = radians(300.0),
          .steering_time_constant_s = 0.02};
}

inline Vehicle reversible_vehicle() {
  Vehicle vehicle{};
  vehicle.wheel_force = {-1.0, 1.0};
  return vehicle;
}

inline awmr::Run run_open_loop(const Plant<double>& plant, const State<double>& start,
                               double duration_s, OpenLoop forces,
                               YawMode mode = YawMode::kDifferential) {
  const Scenario scenario{"open loop", duration_s, start, 0.0, forces};
  return simulate(plant, make_controller(plant, reversible_vehicle(), {}), scenario, mode,
                  {.sample_time_s = 0.01, .substeps = {}});
}

}  // namespace awmr::testing
