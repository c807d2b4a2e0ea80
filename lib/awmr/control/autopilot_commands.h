/// Functions that give the autopilot a route, obstacles, a filter or an observer. They take effect
/// in the next step.
#pragma once

#include "awmr/control/autopilot_state.h"

namespace awmr {

/// Makes the autopilot follow these waypoints from the next step on, instead of any line or path.
/// If the list is empty (`count` 0), the vehicle holds the heading of AutopilotInput::reference.
template <class G, class P>
void follow_waypoints(Autopilot<G, P>& a, const Waypoints<float>& waypoints) {
  a.waypoints = waypoints;
  a.acceptance_m2 = waypoints.acceptance_m * waypoints.acceptance_m;
  a.is_leg_started = false;
  disable(part_of<typename P::Line>(a));
  disable(part_of<typename P::Path>(a));
}

/// Makes the autopilot follow this line from the next step on, instead of any waypoints or path.
/// `sample_time_s`: time between two steps.
template <class G, class P>
void follow_line(Autopilot<G, P>& a, const typename P::Line::Route& line, float sample_time_s) {
  follow_waypoints(a, Waypoints<float>{0, 0, 0.0F, false});
  typename P::Line& part = part_of<typename P::Line>(a);
  part.line = line;
  part.sample_time_s = sample_time_s;
  part.is_started = false;
}

/// Makes the autopilot follow this timed path from the next step on, instead of any waypoints or
/// line. The next step is at t = 0 of the path. `gain_per_s`: gain k of the position feedback in
/// closed_path(), > 0; 0: no position feedback.
template <class G, class P>
void follow_path(Autopilot<G, P>& a, const Lissajous<float>& path, float gain_per_s) {
  follow_waypoints(a, Waypoints<float>{0, 0, 0.0F, false});
  typename P::Path& part = part_of<typename P::Path>(a);
  part.path = path;
  part.gain_per_s = gain_per_s;
  part.is_on = true;
  part.is_started = false;
}

/// Makes the autopilot avoid `count` obstacles from the next step on; 0: none. `sectors` is work
/// space for `count` elements. The arrays must stay valid: every step reads them, without a copy.
template <class G, class P>
void avoid_obstacles(Autopilot<G, P>& a, const Avoidance<float>& avoidance,
                     const Obstacle<float>* obstacles, Sector<float>* sectors, int count) {
  Avoider<float>& part = part_of<Avoider<float>>(a);
  part.avoidance = avoidance;
  part.obstacles = obstacles;
  part.sectors = sectors;
  part.count = count;
  part.state = AvoidanceState();
}

/// Makes the autopilot smooth the heading reference with this filter from the next step on,
/// starting at the vehicle's heading. `sample_time_s`: time between two steps.
template <class G, class P>
void shape_headings(Autopilot<G, P>& a, const HeadingShaping<float>& filter, float sample_time_s) {
  Shaper<float>& part = part_of<Shaper<float>>(a);
  part.filter = filter;
  part.sample_time_s = sample_time_s;
  part.is_on = true;
  part.is_started = false;
}

/// Makes the autopilot estimate the position with these constants. The estimate starts in the next
/// step whose input has a GPS fix as its position (AutopilotInput::position_is_fix).
template <class G, class P>
void filter_position(Autopilot<G, P>& a, const PositionFilter<float>& filter) {
  part_of<Positioner<>>(a).estimate = PositionEstimate<float>(filter);
}

/// Makes the autopilot estimate and compensate the disturbance from the next step on. The first
/// estimate is 0. `sample_time_s`: time between two steps.
template <class G, class P>
void observe_disturbance(Autopilot<G, P>& a, const Observers<float>& observers,
                         float sample_time_s) {
  enable(part_of<Observer>(a), observers, sample_time_s);
}

}  // namespace awmr
