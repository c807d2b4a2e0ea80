/// Optional features of a firmware in addition to heading hold and waypoints. A part that is not
/// compiled in needs no flash, RAM or time. Freestanding C++14.
#pragma once

#include <stdint.h>

#include "awmr/control/disturbance_observer.h"
#include "awmr/control/guidance.h"
#include "awmr/control/guidance_line.h"
#include "awmr/control/guidance_obstacles.h"
#include "awmr/control/guidance_path.h"
#include "awmr/control/guidance_shaping.h"
#include "awmr/control/yaw_mode.h"

namespace awmr {

/// Follows a line or polyline.
struct LineFollower {
  Polyline<float> line;              ///< count 0: none
  PolylineProgress<float> progress;  ///< valid once is_started
  bool is_started;                   ///< the first step along the line was made
};

/// Follows a Lissajous figure as a function of time.
struct PathFollower {
  Lissajous<float> path;
  float gain_per_s;   ///< k of closed_path(), > 0; 0: open_path()
  float held_rad;     ///< psi_d of the last step, valid once is_started
  uint32_t start_ms;  ///< the path's t = 0, valid once is_started
  bool is_on;
  bool is_started;  ///< the first step along the path was made
};

/// Reduces the speed before the last waypoint, or the line's end.
struct SlowDown {
  float distance_m;  ///< m before the end; 0: disabled
};

/// Avoids obstacles.
struct Avoider {
  Avoidance<float> avoidance;
  const Obstacle<float>* obstacles;  ///< not owned; `count` of them
  Sector<float>* sectors;            ///< room for `count`; not owned
  int count;                         ///< 0: none
  AvoidanceState state;
};

/// Shapes the heading reference.
struct Shaper {
  HeadingShaping<float> filter;
  float sample_time_s;
  ShapedHeading<float> state;  ///< valid once is_started
  bool is_on;
  bool is_started;
};

/// Subtracts the estimated disturbance from the command.
struct Observer {
  Observers<float> observers;
  float sample_time_s;
  ObserversState<float> state;  ///< valid once is_started
  bool is_on;
  bool is_started;
};

/// Compensates the dead zone and the back-EMF of the motors.
struct MotorCurve {
  float dead_zone;         ///< F'0 of a wheel, over F_max; 0: none
  float back_emf_s_per_m;  ///< k_e of a motor, s/m; 0: none
};

/// Empty stand-in for a part that is not compiled in. All operations on it are no-ops.
template <class Part>
struct Without {};

/// `Part`, or Without<Part>.
template <bool kIsIn, class Part>
struct Optional {
  typedef Part type;
};
template <class Part>
struct Optional<false, Part> {
  typedef Without<Part> type;
};

/// List of the compiled parts. A firmware defines its own struct with these names.
struct NoParts {
  typedef Without<LineFollower> Line;
  typedef Without<PathFollower> Path;
  typedef Without<SlowDown> Arrival;
  typedef Without<Avoider> Avoidance;
  typedef Without<Shaper> Shaping;
  typedef Without<Observer> Observation;
  typedef Without<MotorCurve> Motors;
  static constexpr CombinedSplit kSplit = CombinedSplit::kRedistribute;
  static constexpr bool kIsDirected = true;  ///< AutopilotInput::speed_unsigned is supported
};

/// All parts, with either split.
template <CombinedSplit split = CombinedSplit::kRedistribute>
struct AllParts {
  typedef LineFollower Line;
  typedef PathFollower Path;
  typedef SlowDown Arrival;
  typedef Avoider Avoidance;
  typedef Shaper Shaping;
  typedef Observer Observation;
  typedef MotorCurve Motors;
  static constexpr CombinedSplit kSplit = split;
  static constexpr bool kIsDirected = true;
};

/// Switches a part off; a no-op for a part that is not compiled in.
template <class Part>
void switch_off(Without<Part>&) {}
inline void switch_off(LineFollower& part) { part.line.count = 0; }
inline void switch_off(PathFollower& part) { part.is_on = false; }
inline void switch_off(SlowDown& part) { part.distance_m = 0.0F; }
inline void switch_off(Avoider& part) { part.count = 0; }
inline void switch_off(Shaper& part) { part.is_on = false; }
inline void switch_off(Observer& part) { part.is_on = false; }

/// Resets the part after a step with the safe command: its memory of the vehicle's motion is no
/// longer valid.
template <class Part>
void begin_anew(Without<Part>&) {}
inline void begin_anew(Avoider& part) { part.state = AvoidanceState(); }
inline void begin_anew(Shaper& part) { part.is_started = false; }
inline void begin_anew(Observer& part) { part.is_started = false; }

}  // namespace awmr
