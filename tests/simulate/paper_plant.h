/// Simulates the paper's vehicle in open loop, for tests of the simulator.
#pragma once

#include "awmr/core/units.h"
#include "awmr/simulate/simulate.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {

inline awmr::Run run_open_loop(const Plant<double>& plant, const State<double>& start,
                               double duration_s, OpenLoop forces,
                               YawMode mode = YawMode::kDifferential) {
  const Scenario scenario{"open loop", duration_s, start, 0.0, forces};
  return simulate(plant, make_controller(plant, paper_vehicle(), {}), scenario, mode,
                  {.sample_time_s = 0.01});
}

}  // namespace awmr::testing
