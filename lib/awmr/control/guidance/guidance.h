/// Guidance of one step: computes the reference heading and speed from waypoints, a line or a timed
/// path, turns the heading away from obstacles, and smooths it. Optional parts that a firmware
/// leaves out have the type Disabled<Part>, whose members and overloads do nothing.
#pragma once

#include "awmr/control/flash.h"
#include "awmr/control/guidance/parts.h"

namespace awmr {

/// Target of the guidance in one step.
template <class T>
struct GuidanceTarget {
  /// Target point of the guidance; obstacles farther away than this point are ignored. Null: no
  /// obstacle is ignored.
  const Position<T>* target_m;
  bool arrived;  ///< the route is finished
};

/// Distance to the target, m, that avoid() gets if the guidance has no target. It exceeds the
/// distance of every obstacle, so that all obstacles count.
template <class T>
constexpr T no_target_m() {
  return T(1e30);
}

/// Parameters and state of the guidance. P lists the optional parts, as AllParts in
/// autopilot_parts.h does.
template <class T, class P>
struct GuidanceLaws : P::Line, P::Path, P::Arrival, P::Avoidance, P::Shaping {
  Waypoints<T> waypoints;        ///< count 0: no waypoints
  T acceptance_m2;               ///< square of waypoints.acceptance_m
  WaypointProgress<T> progress;  ///< valid once is_leg_started
  bool is_leg_started;           ///< at least one step along the waypoints was made
};

/// Disables waypoints and all optional parts.
template <class T, class P>
void disable_guidance(GuidanceLaws<T, P>& g) {
  g.waypoints.count = 0;
  part_of<typename P::Line>(g).disable();
  part_of<typename P::Path>(g).disable();
  part_of<typename P::Arrival>(g).disable();
  part_of<typename P::Avoidance>(g).disable();
  part_of<typename P::Shaping>(g).disable();
}

/// True if the guidance will use the position in the next step.
template <class T, class P>
AWMR_INLINE bool guidance_needs_position(GuidanceLaws<T, P>& g) {
  return g.waypoints.count > 0 || part_of<typename P::Line>(g).needs_position() ||
         part_of<typename P::Path>(g).needs_position() ||
         part_of<typename P::Avoidance>(g).needs_position();
}

/// Sets the reference to a constant heading: its rate and acceleration are 0.
template <class T>
AWMR_INLINE void hold_heading(const T& psi_rad, Reference<T>& ref) {
  ref.psi_rad = psi_rad;
  ref.psi_rate_radps = T(0.0);
  ref.psi_accel_radps2 = T(0.0);
}

/// Reduces the reference speed near the end of the route, within SlowDown::distance_m. `is_last`:
/// the vehicle is on the last leg of the route. `to_go_m()` returns the remaining distance, m.
template <class T, class ToGo>
AWMR_INLINE void slow_down(const Disabled<SlowDown<T>>&, bool, const ToGo&, Reference<T>&) {}
template <class T, class ToGo>
AWMR_INLINE void slow_down(const SlowDown<T>& part, bool is_last, const ToGo& to_go_m,
                           Reference<T>& ref) {
  if (!is_last || !(part.distance_m > T(0.0))) return;
  ref.speed_mps *= arrival_share(part.distance_m, T(to_go_m()));
}

/// Computes the guidance to waypoints by guide() of waypoints.h. If obstacles are avoided,
/// waypoints that an obstacle covers (covers() in obstacles.h) are skipped and counted as missed.
template <class T>
AWMR_INLINE WaypointGuidance<T> guide_clear(const Disabled<Avoider<T>>&,
                                            const Waypoints<T>& waypoints, const T& acceptance_m2,
                                            const Position<T>& position_m,
                                            WaypointProgress<T>& progress) {
  return guide(waypoints, acceptance_m2, position_m, progress);
}
template <class T>
AWMR_CALLED WaypointGuidance<T> guide_clear(const Avoider<T>& part, const Waypoints<T>& waypoints,
                                            const T& /*acceptance_m2*/,
                                            const Position<T>& position_m,
                                            WaypointProgress<T>& progress) {
  WaypointGuidance<T> guided = guide(waypoints, position_m, progress);
  while (!guided.finished &&
         is_covered(part.avoidance, part.obstacles, part.count, waypoints.points_m[progress.next],
                    waypoints.acceptance_m)) {
    ++progress.missed;
    ++progress.next;
    guided = guide(waypoints, position_m, progress);
  }
  return guided;
}

/// Sets the reference heading to the direction of the next waypoint. Returns false if none is set.
template <class T, class P, class Time>
AWMR_INLINE bool guide_by_waypoints(GuidanceLaws<T, P>& g, const VehiclePose<T, Time>& at,
                                    Reference<T>& ref, GuidanceTarget<T>& target) {
  if (g.waypoints.count <= 0) return false;
  if (!g.is_leg_started) {
    g.progress = start_waypoints(at.position_m, at.measured.psi_rad);
    g.is_leg_started = true;
  }
  const WaypointGuidance<T> guided = guide_clear(part_of<typename P::Avoidance>(g), g.waypoints,
                                                 g.acceptance_m2, at.position_m, g.progress);
  hold_heading(guided.psi_rad, ref);
  target.arrived = guided.finished;
  target.target_m = g.waypoints.points_m + (g.progress.next - (guided.finished ? 1 : 0));
  slow_down(
      part_of<typename P::Arrival>(g), g.progress.next + 1 >= g.waypoints.count,
      [&] { return distance_m(at.position_m, *target.target_m); }, ref);
  return true;
}

/// Computes the guidance along the line by guide() of line.h, and updates the stored progress.
template <class T, class Law>
AWMR_INLINE PolylineGuidance<T> guide_line(LineFollower<T, Law>& part,
                                           const Position<T>& position_m,
                                           const LineMotion<T>& motion) {
  return guide(part.line, position_m, motion, part.progress);
}

/// Sets the reference heading for following the line. Returns false if no line is set.
template <class Part, class Arrival, class T, class Time>
AWMR_INLINE bool guide_by_line(Disabled<Part>&, const Arrival&, const VehiclePose<T, Time>&,
                               Reference<T>&, GuidanceTarget<T>&) {
  return false;
}
template <class Line, class Arrival, class T, class Time>
AWMR_CALLED bool guide_by_line(Line& part, const Arrival& arrival, const VehiclePose<T, Time>& at,
                               Reference<T>& ref, GuidanceTarget<T>& target) {
  if (part.line.count <= 0) return false;
  if (!part.is_started) part.progress = start_polyline(at.measured.psi_rad);
  part.is_started = true;
  const LineMotion<T> motion = {sideslip_rad(at.measured.u_mps, at.measured.v_mps),
                                at.measured.u_mps, part.sample_time_s};
  const PolylineGuidance<T> guided = guide_line(part, at.position_m, motion);
  hold_heading(guided.psi_rad, ref);
  const bool is_last = part.progress.segment + 2 >= part.line.count;
  slow_down(
      arrival, is_last, [&guided] { return guided.to_go_m; }, ref);
  target.target_m = is_last ? part.line.points_m + (part.line.count - 1) : 0;
  target.arrived = guided.finished;
  return true;
}

/// Takes heading, heading rate and speed of the reference from the timed path, but keeps a
/// reference speed above 0. No-op if no path is set.
template <class Part, class T, class Time>
AWMR_INLINE void guide_by_path(Disabled<Part>&, const VehiclePose<T, Time>&, Reference<T>&) {}
template <class Path, class T, class Time>
AWMR_CALLED void guide_by_path(Path& part, const VehiclePose<T, Time>& at, Reference<T>& ref) {
  if (!part.is_on) return;
  if (!part.is_started) {
    part.held_rad = at.measured.psi_rad;
    part.start = at.now;
    part.is_started = true;
  }
  const PathPoint<T> point = part.path.at(elapsed_s(part.start, at.now));
  const PathGuidance<T> guided =
      part.gain_per_s > T(0.0)
          ? closed_path(point, part.gain_per_s, at.position_m,
                        sideslip_rad(at.measured.u_mps, at.measured.v_mps), part.held_rad)
          : open_path(point, part.held_rad);
  part.held_rad = guided.psi_rad;
  hold_heading(guided.psi_rad, ref);
  ref.psi_rate_radps = guided.psi_rate_radps;
  if (!(ref.speed_mps > T(0.0))) ref.speed_mps = guided.speed_mps;
}

/// Sets the reference for following waypoints, a line or a timed path, whichever is set.
template <class T, class P, class Time>
AWMR_INLINE GuidanceTarget<T> guide_by_route(GuidanceLaws<T, P>& g, const VehiclePose<T, Time>& at,
                                             Reference<T>& ref) {
  GuidanceTarget<T> target = {0, false};
  if (!guide_by_waypoints(g, at, ref, target) &&
      !guide_by_line(part_of<typename P::Line>(g), part_of<typename P::Arrival>(g), at, ref,
                     target)) {
    guide_by_path(part_of<typename P::Path>(g), at, ref);
  }
  return target;
}

/// Turns the reference heading away from obstacles, and reduces the reference speed if an obstacle
/// is close ahead.
template <class Part, class T, class Time>
AWMR_INLINE void steer_around_obstacles(Disabled<Part>&, const VehiclePose<T, Time>&,
                                        const GuidanceTarget<T>&, Reference<T>&) {}
template <class T, class Time>
AWMR_CALLED void steer_around_obstacles(Avoider<T>& part, const VehiclePose<T, Time>& at,
                                        const GuidanceTarget<T>& target, Reference<T>& ref) {
  if (part.count <= 0) return;
  const T target_m =
      target.target_m != 0 ? distance_m(at.position_m, *target.target_m) : no_target_m<T>();
  const Avoided<T> avoided =
      avoid(part.avoidance, part.obstacles, part.sectors, part.count, at.position_m,
            at.measured.psi_rad, at.measured.u_mps, ref.psi_rad, target_m, part.state);
  ref.speed_mps *= avoided.speed_share;
  if (!avoided.active) return;
  ref.psi_rad = avoided.psi_rad;
  ref.psi_rate_radps = T(0.0);
}

/// Smooths the reference heading by the filter of heading_shaping.h, and sets the heading rate and
/// acceleration of the reference. The filter starts at the vehicle's heading.
template <class Part, class T, class Time>
AWMR_INLINE void shape_heading(Disabled<Part>&, const VehiclePose<T, Time>&, Reference<T>&) {}
template <class T, class Time>
AWMR_CALLED void shape_heading(Shaper<T>& part, const VehiclePose<T, Time>& at, Reference<T>& ref) {
  if (!part.is_on) return;
  if (!part.is_started) part.state = start_shaping(at.measured.psi_rad);
  part.is_started = true;
  shape(part.filter, ref.psi_rad, part.sample_time_s, part.state);
  ref.psi_rad = part.state.psi_rad;
  ref.psi_rate_radps = part.state.psi_rate_radps;
  ref.psi_accel_radps2 = part.state.psi_accel_radps2;
}

}  // namespace awmr
