/// What a firmware can do beyond holding a heading and going to waypoints. Each part is compiled in
/// or left out; one that is left out takes neither flash nor RAM nor time. Freestanding C++14.
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
  Polyline<float> line;              ///< count 0: none to follow
  PolylineProgress<float> progress;  ///< valid once is_started
  bool is_started;                   ///< the first step along the line was made
};

/// Follows a Lissajous figure in time.
struct PathFollower {
  Lissajous<float> path;
  float gain_per_s;   ///< k of closed_path(), > 0; 0: open_path()
  float held_rad;     ///< psi_d of the step before, valid once is_started
  uint32_t start_ms;  ///< the path's t = 0, valid once is_started
  bool is_on;
  bool is_started;  ///< the first step along the path was made
};

/// Lowers the speed before the last waypoint, or the line's end.
struct SlowDown {
  float distance_m;  ///< m, from where on; 0: not at all
};

/// Steers clear of obstacles.
struct Avoider {
  Avoidance<float> avoidance;
  const Obstacle<float>* obstacles;  ///< not owned; `count` of them
  Sector<float>* sectors;            ///< room for `count`; not owned
  int count;                         ///< 0: none
  AvoidanceState state;
};

/// Shapes the heading that is held or led to.
struct Shaper {
  HeadingShaping<float> filter;
  float sample_time_s;
  ShapedHeading<float> state;  ///< valid once is_started
  bool is_on;
  bool is_started;
};

/// Takes the disturbance that it sees off the command.
struct Observer {
  Observers<float> observers;
  float sample_time_s;
  ObserversState<float> state;  ///< valid once is_started
  bool is_on;
  bool is_started;
};

/// Makes up for what the motors do not make of a command: the dead zone and the back-EMF.
struct MotorCurve {
  float dead_zone;         ///< F'0 of a wheel, over F_max; 0: none
  float back_emf_s_per_m;  ///< k_e of a motor, s/m; 0: none
};

/// In the place of a part that was left out: it is empty, and whatever is done with it is nothing.
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

/// Which parts there are. A firmware has a struct of its own with these names.
struct NoParts {
  typedef Without<LineFollower> Line;
  typedef Without<PathFollower> Path;
  typedef Without<SlowDown> Arrival;
  typedef Without<Avoider> Avoidance;
  typedef Without<Shaper> Shaping;
  typedef Without<Observer> Observation;
  typedef Without<MotorCurve> Motors;
  static constexpr CombinedSplit kSplit = CombinedSplit::kRedistribute;
  static constexpr bool kIsDirected = true;  ///< AutopilotInput::speed_unsigned is known
};

/// All of them, with either split.
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

/// Parts that are not there are never to be switched off, nor need they be.
template <class Part>
void switch_off(Without<Part>&) {}
inline void switch_off(LineFollower& part) { part.line.count = 0; }
inline void switch_off(PathFollower& part) { part.is_on = false; }
inline void switch_off(SlowDown& part) { part.distance_m = 0.0F; }
inline void switch_off(Avoider& part) { part.count = 0; }
inline void switch_off(Shaper& part) { part.is_on = false; }
inline void switch_off(Observer& part) { part.is_on = false; }

/// Begins anew at the next step, after one that gave the safe command: what the part remembers of
/// the vehicle's motion no longer holds.
template <class Part>
void begin_anew(Without<Part>&) {}
inline void begin_anew(Avoider& part) { part.state = AvoidanceState(); }
inline void begin_anew(Shaper& part) { part.is_started = false; }
inline void begin_anew(Observer& part) { part.is_started = false; }

}  // namespace awmr
