/// Random obstacle layouts between a start at the origin and a goal 30 m ahead.
#pragma once

#include "awmr/core/random.h"
#include "awmr/core/units.h"
#include "awmr/simulate/passage.h"
#include "awmr/simulate/scenario.h"

namespace awmr::testing {

inline constexpr Avoidance<double> kAvoidance{.mmd_base_m = 6.0,
                                              .mmd_per_speed_s = 1.0,
                                              .sigma_rad = radians(10.0),
                                              .vehicle_radius_m = 0.8,
                                              .clearance_m = 0.5,
                                              .hysteresis_m = 0.5,
                                              .side_hysteresis_rad = radians(90.0),
                                              .brake_m = 1.5};
inline constexpr Position<double> kGoal_m{30.0, 0.0};

/// Scenario with 1 to 10 discs with radii of 0.3 to 2.5 m, from 3 m ahead of the start to beyond
/// the goal. They leave start and goal free.
inline Scenario random_layout(std::uint64_t number) {
  Random random(20260117, number);
  Scenario scenario{
      .name = "layout",
      .duration_s = 60.0,
      .initial = {},
      .speed_mps = 1.0,
      .guidance =
          WaypointPath{
              .points_m = {kGoal_m}, .acceptance_m = 1.0, .skip_passed = false, .slow_down_m = {}},
      .avoidance = kAvoidance};
  const auto between = [&](double lo, double hi) { return lo + (hi - lo) * random.uniform(); };
  const int count = 1 + static_cast<int>(10.0 * random.uniform());
  const double grow_m = kAvoidance.vehicle_radius_m + kAvoidance.clearance_m;
  while (static_cast<int>(scenario.obstacles.size()) < count) {
    const Obstacle<double> o{{between(3.0, 32.0), between(-8.0, 8.0)}, between(0.3, 2.5)};
    const auto room = [&](const Position<double>& end) {
      return distance_m(o.centre_m, end) > o.radius_m + grow_m;
    };
    if (room({0.0, 0.0}) && room(kGoal_m)) scenario.obstacles.push_back(o);
  }
  return scenario;
}

inline bool has_passage(const Scenario& scenario) {
  return passage_exists(scenario.obstacles, kAvoidance.vehicle_radius_m + kAvoidance.clearance_m,
                        {0.0, 0.0}, kGoal_m);
}

}  // namespace awmr::testing
