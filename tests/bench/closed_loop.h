/// Hand-written closed loop of a scenario with heading commands, for any scalar type. The caller
/// supplies the controller and the equations of motion.
#pragma once

#include <cmath>

#include "awmr/simulate/metering.h"
#include "awmr/simulate/motion.h"
#include "awmr/simulate/scenario_guidance.h"

namespace awmr::bench {

/// Executes a run and returns its metrics. `command(measured, reference)` returns the allocation
/// (wheel forces and steering) of a sample; `move(t_s, allocation, state)` advances the state by
/// one sample.
template <class T, class Command, class Move>
MetricsAccumulator<T> driven(const Scenario& scenario, double sample_time_s,
                             const Resistance<T>& yaw, const MetricsVehicle<T>& vehicle,
                             const Command& command, const Move& move) {
  const auto& headings = std::get<HeadingSteps>(scenario.guidance);
  const auto task = metrics_task(scenario);
  const T none = T(0.0);
  MetricsAccumulator<T> sums;
  State<T> s{};
  SideForces<T> held{none, none};
  double goal_before_rad = 0.0;
  const int samples = static_cast<int>(scenario.duration_s / sample_time_s + 1e-9);
  for (int k = 0; k <= samples; ++k) {
    const double t_s = k * sample_time_s;
    const double goal_rad = heading_at(headings, t_s);
    const Allocation<T> a =
        command(Measurement<T>{s.psi_rad, s.u_mps, s.v_mps, s.r_radps},
                Reference<T>{T(goal_rad), none, none, T(scenario.speed_mps), none});
    measure<T>(
        {s, a.force, at_all_wheels(held, T(1.0)), a.steering_rad, yaw(s.r_radps), T(goal_rad), none,
         none, none, T(scenario.speed_mps), none},
        vehicle, task,
        {t_s, sample_time_s, k == 0, k == 0 || std::abs(goal_rad - goal_before_rad) > 0.0, false},
        sums);
    goal_before_rad = goal_rad;
    held = a.force;
    if (k < samples) move(t_s, a, s);
  }
  return sums;
}

}  // namespace awmr::bench
