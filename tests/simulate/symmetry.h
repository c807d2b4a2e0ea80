/// Functions that mirror a scenario, or rotate and move it.
#pragma once

#include <cmath>

#include "awmr/simulate/scenario.h"

namespace awmr::testing {

template <class Term>
void negate(std::vector<Term>& terms) {
  for (Term& term : terms) term.value = -term.value;
}

inline void mirror_points(std::vector<Position<double>>& points) {
  for (Position<double>& point : points) point.y_m = -point.y_m;
}

/// The scenario mirrored at the x axis: y, psi, v, r and d_r change their sign, and so do
/// disturbances in sway and yaw with their random numbers.
inline Scenario mirrored(Scenario s) {
  s.initial.y_m *= -1.0;
  s.initial.psi_rad *= -1.0;
  s.initial.v_mps *= -1.0;
  s.initial.r_radps *= -1.0;
  if (auto* open = std::get_if<OpenLoop>(&s.guidance)) open->tau_turn_m *= -1.0;
  if (auto* heading = std::get_if<HeadingSteps>(&s.guidance)) {
    for (HeadingStep& step : heading->steps) step.psi_rad *= -1.0;
  }
  if (auto* points = std::get_if<WaypointPath>(&s.guidance)) mirror_points(points->points_m);
  if (auto* line = std::get_if<LinePath>(&s.guidance)) mirror_points(line->points_m);
  if (auto* timed = std::get_if<LissajousPath>(&s.guidance)) timed->path.amplitude_y_m *= -1.0;
  for (Obstacle<double>& obstacle : s.obstacles) obstacle.centre_m.y_m *= -1.0;
  negate(s.disturbance.sway);
  negate(s.disturbance.yaw);
  if (s.disturbance.slope) s.disturbance.slope->downhill_rad *= -1.0;
  for (WheelFault& fault : s.faults) {
    for (Wheel& wheel : fault.wheels) wheel = static_cast<Wheel>(static_cast<int>(wheel) ^ 1);
  }
  for (SlipperyPatch& patch : s.patches) patch.centre_m.y_m *= -1.0;
  if (s.sensors) {
    for (Channel* channel : {&s.sensors->heading, &s.sensors->yaw_rate}) {
      channel->noise *= -1.0;
      channel->bias *= -1.0;
    }
    if (s.sensors->gps) s.sensors->gps->y.noise *= -1.0;
  }
  return s;
}

/// Rotation about the origin by `angle_rad`, then translation.
struct Elsewhere {
  double angle_rad, dx_m, dy_m;

  Position<double> of(const Position<double>& p) const {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return {c * p.x_m - s * p.y_m + dx_m, s * p.x_m + c * p.y_m + dy_m};
  }
  void move(std::vector<Position<double>>& points) const {
    for (Position<double>& point : points) point = of(point);
  }
  /// The scenario after this motion. Not for a Lissajous path, which cannot be rotated.
  Scenario of(Scenario s) const {
    const Position<double> start = of(Position<double>{s.initial.x_m, s.initial.y_m});
    s.initial.x_m = start.x_m;
    s.initial.y_m = start.y_m;
    s.initial.psi_rad += angle_rad;
    if (auto* heading = std::get_if<HeadingSteps>(&s.guidance)) {
      for (HeadingStep& step : heading->steps) step.psi_rad += angle_rad;
    }
    if (auto* points = std::get_if<WaypointPath>(&s.guidance)) move(points->points_m);
    if (auto* line = std::get_if<LinePath>(&s.guidance)) move(line->points_m);
    for (Obstacle<double>& obstacle : s.obstacles) obstacle.centre_m = of(obstacle.centre_m);
    if (s.disturbance.slope) s.disturbance.slope->downhill_rad += angle_rad;
    for (SlipperyPatch& patch : s.patches) patch.centre_m = of(patch.centre_m);
    return s;
  }
};

}  // namespace awmr::testing
