/// Optional parts of the guidance, which a firmware can leave out (optional_part.h): parameters,
/// state and members of each.
#pragma once

#include <stdint.h>

#include "awmr/control/guidance/heading_shaping.h"
#include "awmr/control/guidance/line_laws.h"
#include "awmr/control/guidance/obstacles.h"
#include "awmr/control/guidance/timed_path.h"
#include "awmr/control/guidance/waypoints.h"
#include "awmr/control/measurement.h"
#include "awmr/control/optional_part.h"

namespace awmr {

/// Pose and motion of the vehicle for the guidance of one step. `Time` is the type of the clock: on
/// the chip uint32_t, in ms, which wraps to 0 after 49.7 days; in the simulator double, in s.
template <class T, class Time>
struct VehiclePose {
  const Position<T>& position_m;
  const Measurement<T>& measured;
  Time now;
};

inline float elapsed_s(uint32_t start_ms, uint32_t now_ms) {
  return 0.001F * static_cast<float>(now_ms - start_ms);
}
inline double elapsed_s(double start_s, double now_s) { return now_s - start_s; }

/// Follows a line or polyline.
template <class T, class Law = LineOfSight<T>>
struct LineFollower {
  typedef Polyline<T, Law> Route;
  Route line;                    ///< count 0: no line
  T sample_time_s;               ///< time between two guidance steps, > 0
  PolylineProgress<T> progress;  ///< valid once is_started
  bool is_started;               ///< at least one step along the line was made

  void disable() { line.count = 0; }
  bool needs_position() const { return line.count > 0; }
};

/// Follows a Lissajous figure as a function of time.
template <class T, class Time>
struct PathFollower {
  Lissajous<T> path;
  /// Gain k of the position feedback in closed_path(), > 0. 0: no feedback, open_path() is used.
  T gain_per_s;
  T held_rad;  ///< last psi_d, rad; valid once is_started
  Time start;  ///< time at which the path began (its t = 0), valid once is_started
  bool is_on;
  bool is_started;  ///< at least one step along the path was made

  void disable() { is_on = false; }
  bool needs_position() const { return is_on && gain_per_s > T(0.0); }
};

/// Reduces the reference speed before the last waypoint, or before the end of the line.
template <class T>
struct SlowDown {
  /// Distance from the end of the route at which the speed begins to fall, m. 0: disabled.
  T distance_m;

  void disable() { distance_m = T(0.0); }
};

/// Avoids obstacles.
template <class T>
struct Avoider {
  Avoidance<T> avoidance;
  const Obstacle<T>* obstacles;  ///< not owned; `count` of them
  Sector<T>* sectors;            ///< room for `count`; not owned
  int count;                     ///< 0: none
  AvoidanceState state;

  void disable() { count = 0; }
  void reset() { state = AvoidanceState(); }
  bool needs_position() const { return count > 0; }
};

/// Smooths the heading reference.
template <class T>
struct Shaper {
  HeadingShaping<T> filter;
  T sample_time_s;
  ShapedHeading<T> state;  ///< valid once is_started
  bool is_on;
  bool is_started;

  void disable() { is_on = false; }
  void reset() { is_started = false; }
};

}  // namespace awmr
