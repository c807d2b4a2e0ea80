/// Functions of the autopilot's optional parts in one step. Each has a no-op overload for
/// Without<Part>, so autopilot_step() needs no tests for missing parts. Freestanding C++14.
#pragma once

#include <stdint.h>

#include "awmr/control/allocation.h"
#include "awmr/control/autopilot_parts.h"
#include "awmr/control/controller.h"
#include "awmr/control/flash.h"

namespace awmr {

/// Vehicle pose and motion for the guidance of one step.
struct Whereabouts {
  const Position<float>& position_m;
  const Measurement<float>& measured;
  uint32_t now_ms;
};

/// Target of the guidance in one step.
struct Goal {
  const Position<float>* target_m;  ///< 0: no point, or none nearby
  bool arrived;                     ///< the route is finished
};

/// True if the part reads the position in the next step.
template <class Part>
AWMR_INLINE bool needs_position(const Without<Part>&) {
  return false;
}
inline bool needs_position(const LineFollower& part) { return part.line.count > 0; }
inline bool needs_position(const PathFollower& part) { return part.is_on && part.gain_per_s > 0; }
inline bool needs_position(const Avoider& part) { return part.count > 0; }

/// Reduces the speed on the last leg. `to_go_m` is a function that returns the remaining distance,
/// m.
template <class ToGo>
AWMR_INLINE void slow_down(const Without<SlowDown>&, bool, const ToGo&, Reference<float>&) {}
template <class ToGo>
AWMR_INLINE void slow_down(const SlowDown& part, bool is_last, const ToGo& to_go_m,
                           Reference<float>& ref) {
  if (!is_last || !(part.distance_m > 0.0F)) return;
  ref.speed_mps *= arrival_share(part.distance_m, to_go_m());
}

/// guide() in guidance.h, skipping waypoints covered by obstacles.
AWMR_INLINE WaypointGuidance<float> guide_clear(const Without<Avoider>&,
                                                const Waypoints<float>& waypoints,
                                                const float& acceptance_m2,
                                                const Position<float>& position_m,
                                                WaypointProgress<float>& progress) {
  return guide(waypoints, acceptance_m2, position_m, progress);
}
inline WaypointGuidance<float> guide_clear(const Avoider& part, const Waypoints<float>& waypoints,
                                           const float& /*acceptance_m2*/,
                                           const Position<float>& position_m,
                                           WaypointProgress<float>& progress) {
  return guide_past_covered(part.avoidance, part.obstacles, part.count, waypoints, position_m,
                            progress);
}

/// Writes the heading along the line into the reference. False: there is no line to follow.
template <class Arrival>
AWMR_INLINE bool lead(Without<LineFollower>&, const Arrival&, const Whereabouts&, Reference<float>&,
                      Goal&) {
  return false;
}
template <class Arrival>
AWMR_CALLED bool lead(LineFollower& part, const Arrival& arrival, const Whereabouts& at,
                      Reference<float>& ref, Goal& goal) {
  if (part.line.count <= 0) return false;
  if (!part.is_started) part.progress = start_polyline(at.measured.psi_rad);
  part.is_started = true;
  const float sideslip = sideslip_rad(at.measured.u_mps, at.measured.v_mps);
  const PolylineGuidance<float> guided = guide(part.line, at.position_m, sideslip, part.progress);
  ref.psi_rad = guided.psi_rad;
  ref.psi_rate_radps = 0.0F;
  ref.psi_accel_radps2 = 0.0F;
  const bool is_last = part.progress.segment + 2 >= part.line.count;
  slow_down(
      arrival, is_last, [&guided] { return guided.to_go_m; }, ref);
  goal.target_m = is_last ? part.line.points_m + (part.line.count - 1) : 0;
  goal.arrived = guided.finished;
  return true;
}

/// Writes heading and speed of the path into the reference; a requested speed above 0 is kept.
/// False: there is no path to follow.
AWMR_INLINE bool lead(Without<PathFollower>&, const Whereabouts&, Reference<float>&) {
  return false;
}
AWMR_CALLED inline bool lead(PathFollower& part, const Whereabouts& at, Reference<float>& ref) {
  if (!part.is_on) return false;
  if (!part.is_started) {
    part.held_rad = at.measured.psi_rad;
    part.start_ms = at.now_ms;
    part.is_started = true;
  }
  const float t_s = 0.001F * static_cast<float>(at.now_ms - part.start_ms);
  const PathPoint<float> point = part.path.at(t_s);
  const PathGuidance<float> guided =
      part.gain_per_s > 0.0F
          ? closed_path(point, part.gain_per_s, at.position_m,
                        sideslip_rad(at.measured.u_mps, at.measured.v_mps), part.held_rad)
          : open_path(point, part.held_rad);
  part.held_rad = guided.psi_rad;
  ref.psi_rad = guided.psi_rad;
  ref.psi_rate_radps = guided.psi_rate_radps;
  ref.psi_accel_radps2 = 0.0F;
  if (!(ref.speed_mps > 0.0F)) ref.speed_mps = guided.speed_mps;
  return true;
}

/// Target distance that is larger than any obstacle's, m.
constexpr float kNoTarget_m = 1e30F;

/// Turns the reference heading away from obstacles and reduces its speed if that is not enough.
AWMR_INLINE void steer_clear(Without<Avoider>&, const Whereabouts&, const Goal&,
                             Reference<float>&) {}
AWMR_CALLED inline void steer_clear(Avoider& part, const Whereabouts& at, const Goal& goal,
                                    Reference<float>& ref) {
  if (part.count <= 0) return;
  const float target_m =
      goal.target_m != 0 ? distance_m(at.position_m, *goal.target_m) : kNoTarget_m;
  const Avoided<float> avoided =
      avoid(part.avoidance, part.obstacles, part.sectors, part.count, at.position_m,
            at.measured.psi_rad, at.measured.u_mps, ref.psi_rad, target_m, part.state);
  ref.speed_mps *= avoided.speed_share;
  if (!avoided.active) return;
  ref.psi_rad = avoided.psi_rad;
  ref.psi_rate_radps = 0.0F;
}

/// Shapes the reference's heading, starting from the vehicle's heading.
AWMR_INLINE void shape_heading(Without<Shaper>&, const Whereabouts&, Reference<float>&) {}
AWMR_CALLED inline void shape_heading(Shaper& part, const Whereabouts& at, Reference<float>& ref) {
  if (!part.is_on) return;
  if (!part.is_started) part.state = start_shaping(at.measured.psi_rad);
  part.is_started = true;
  shape(part.filter, ref.psi_rad, part.sample_time_s, part.state);
  // Without wrapping, full turns accumulate until a float cannot resolve the heading.
  part.state.psi_rad = called_wrap_angle(part.state.psi_rad);
  ref.psi_rad = part.state.psi_rad;
  ref.psi_rate_radps = part.state.psi_rate_radps;
  ref.psi_accel_radps2 = part.state.psi_accel_radps2;
}

/// Motor commands that make the forces with a dead zone.
AWMR_INLINE void make_up_dead_zone(const Without<MotorCurve>&, SideForces<float>&) {}
inline void make_up_dead_zone(const MotorCurve& part, SideForces<float>& force) {
  force = with_dead_zone(force, part.dead_zone);
}

/// Allocation limits at the speed u, m/s.
AWMR_INLINE const AllocationConstants<float>& limits_at(const Without<MotorCurve>&,
                                                        const AllocationConstants<float>& c,
                                                        const float& /*u_mps*/) {
  return c;
}
inline AllocationConstants<float> limits_at(const MotorCurve& part,
                                            const AllocationConstants<float>& c,
                                            const float& u_mps) {
  return at_speed(c, part.back_emf_s_per_m, u_mps);
}

/// Motor drives that make the forces with back-EMF.
AWMR_INLINE void make_up_back_emf(const Without<MotorCurve>&, const AllocationConstants<float>&,
                                  const Measurement<float>&, SideForces<float>&) {}
inline void make_up_back_emf(const MotorCurve& part, const AllocationConstants<float>& c,
                             const Measurement<float>& m, SideForces<float>& force) {
  force = motor_drives(force, c, part.back_emf_s_per_m, m.u_mps, m.r_radps);
}

/// Allocation request: limits, the laws' outputs, and the resulting command.
struct Asked {
  const AllocationConstants<float>& limits;
  float& tau_speed;
  float& tau_turn_m;
  Allocation<float>& command;
};

/// Allocates the laws' outputs.
template <class G>
AWMR_INLINE void allocate_asked(Without<Observer>&, const PreparedController<float, G>&,
                                YawMode mode, CombinedSplit split, const Measurement<float>&,
                                const Asked& asked) {
  allocate(kFourWheelSteering, yaw_split<float>(mode, split), asked.tau_speed, asked.tau_turn_m,
           asked.limits, asked.command);
}

/// Allocates the laws' outputs minus the estimated disturbance.
template <class G>
void allocate_asked(Observer& part, const PreparedController<float, G>& c, YawMode mode,
                    CombinedSplit split, const Measurement<float>& m, const Asked& asked) {
  const ControlConstants<float>& k = c.constants;
  ObservedMotion<float> motion{};
  AxisForces<float> disturbance{};
  if (part.is_on) {
    motion = {{k.mass_norm * m.u_mps, k.inertia_norm * m.r_radps},
              {c.surge(m.u_mps), c.yaw(m.r_radps)},
              k.mass_norm * m.r_radps * m.v_mps};
    if (!part.is_started) part.state = start_observers(part.observers, motion.momentum);
    part.is_started = true;
    disturbance = estimate(part.observers, motion, part.state);
    asked.tau_turn_m -= disturbance.yaw_m;
    asked.tau_speed -= disturbance.surge;
  }
  allocate(kFourWheelSteering, yaw_split<float>(mode, split), asked.tau_speed, asked.tau_turn_m,
           asked.limits, asked.command);
  if (!part.is_on) return;
  const GeneralisedForces<float> allocated =
      generalised_forces(asked.limits.front_axle_m, asked.limits.half_track_m, asked.command.force,
                         asked.command.steering_rad);
  advance(part.observers, disturbance, {asked.tau_speed, asked.tau_turn_m}, allocated, motion,
          part.sample_time_s, part.state);
}

}  // namespace awmr
