/// One complete step of the firmware: checks, guidance, heading and speed laws, allocation, limits.
/// The optional parts are in autopilot_parts.h, their functions in autopilot_guidance.h.
/// Freestanding C++14. The host's float run compiles this source, too, and gives the same bits.
#pragma once

#include <stdint.h>

#include "awmr/control/autopilot_guidance.h"
#include "awmr/control/autopilot_parts.h"
#include "awmr/control/controller.h"
#include "awmr/control/directed_speed.h"
#include "awmr/control/guidance.h"
#include "awmr/control/parameters_block.h"
#include "awmr/control/resistance_table.h"
#include "awmr/control/safety.h"

namespace awmr {

/// Input of one step.
struct AutopilotInput {
  uint8_t mode;                 ///< a YawMode
  Measurement<float> measured;  ///< motion of the vehicle from the sensors
  Position<float> position_m;   ///< read only if guidance needs it
  Reference<float> reference;   ///< its heading is ignored while guidance is active
  InputTimes times;             ///< time stamps of all inputs
  /// Not 0: measured.u_mps is |u|, as from a GPS; its sign is computed (directed_speed.h).
  uint8_t speed_unsigned = 0;
};

/// Output of one step.
struct AutopilotOutput {
  Allocation<float> command;  ///< for the motors and the servo
  float tau_speed;            ///< requested by the speed law, dimensionless; 0 on a fault
  float tau_turn_m;           ///< requested by the heading law, m; 0 on a fault
  float psi_ref_rad;          ///< heading reference
  bool arrived;               ///< the route is finished
  uint8_t fault;              ///< SafetyFault bits; not 0: `command` is the safe command
};

/// State of the autopilot between two steps. G is the type of the resistances, as in Controller; P
/// lists the compiled parts (autopilot_parts.h).
template <class G, class P = NoParts>
struct Autopilot : P::Line,
                   P::Path,
                   P::Arrival,
                   P::Avoidance,
                   P::Shaping,
                   P::Observation,
                   P::Motors {
  PreparedController<float, G> controller;
  SafetyLimits limits;
  Waypoints<float> waypoints;        ///< count 0: none
  float acceptance_m2;               ///< the square of waypoints.acceptance_m
  WaypointProgress<float> progress;  ///< valid once is_leg_started
  uint32_t last_step_ms;             ///< valid once has_stepped
  DirectedSpeed<float> direction;    ///< for a speed without a sign
  uint32_t direction_ms;             ///< InputTimes::speed_ms of the last reading
  float mass_inverse;                ///< 1/m'
  bool has_stepped;                  ///< at least one step since the start
  bool is_leg_started;               ///< the first step towards the waypoints was made
  bool are_parameters_good;          ///< the check sum was correct at the start
};

/// A part of the autopilot, or its Without stand-in: `part_of<typename P::Line>(a)`.
template <class Part, class A>
Part& part_of(A& a) {
  return static_cast<Part&>(a);
}

/// Switches all parts off.
template <class G, class P>
void switch_parts_off(Autopilot<G, P>& a) {
  switch_off(part_of<typename P::Line>(a));
  switch_off(part_of<typename P::Path>(a));
  switch_off(part_of<typename P::Arrival>(a));
  switch_off(part_of<typename P::Avoidance>(a));
  switch_off(part_of<typename P::Shaping>(a));
  switch_off(part_of<typename P::Observation>(a));
}

/// Sets the motors' curve, if it is compiled in.
inline void set_motors(const RestBlock*, Without<MotorCurve>&) {}
inline void set_motors(const RestBlock* rest, MotorCurve& part) {
  part.dead_zone = rest != 0 ? flash_float(&rest->dead_zone) : 0.0F;
  part.back_emf_s_per_m = rest != 0 ? flash_float(&rest->back_emf_s_per_m) : 0.0F;
}

/// Enables the observer that was tuned with the gains, if it is compiled in.
inline void set_observer(const ObserverBlock*, Without<Observer>&) {}
inline void set_observer(const ObserverBlock* tuned, Observer& part) {
  if (tuned == 0) return;
  ObserverBlock read;
  read_flash(tuned, read);
  part.observers = {
      {read.bandwidth_radps, read.yaw_max_m}, {read.bandwidth_radps, read.surge_max}, true};
  part.sample_time_s = read.sample_time_s;
  part.is_on = true;
  part.is_started = false;
}

/// Reads the parameters and checks them against `crc`, the check sum in the emitted header. If they
/// differ, returns false, and every step then gives the safe command. On an AVR, the block, the
/// lines, `rest` and `observer` are in flash. `rest` is for RestingTable and MotorCurve, `observer`
/// for Observer.
template <class G, class P>
bool start_autopilot(Autopilot<G, P>& a, const ParameterBlock* block,
                     const ResistanceLine* surge_lines, size_t surge_count,
                     const ResistanceLine* yaw_lines, size_t yaw_count, uint32_t crc,
                     const RestBlock* rest = 0, const ObserverBlock* observer = 0) {
  PreparedController<float, G>& c = a.controller;
  read_flash(&block->constants, c.constants);
  set_resistance(&block->surge_table, block->surge_alpha_beta, surge_lines, c.surge);
  set_resistance(&block->yaw_table, block->yaw_alpha_beta, yaw_lines, c.yaw);
  if (rest != 0) {
    set_rest(&rest->surge_rest_speed, &rest->surge_at_rest, c.surge);
    set_rest(&rest->yaw_rest_speed, &rest->yaw_at_rest, c.yaw);
  }
  set_motors(rest, part_of<typename P::Motors>(a));
  read_flash(&block->safety, a.limits);
  a.waypoints.count = 0;
  switch_parts_off(a);
  set_observer(observer, part_of<typename P::Observation>(a));
  a.has_stepped = false;
  a.direction = DirectedSpeed<float>();
  a.direction_ms = 0;
  a.mass_inverse = 1.0F / c.constants.mass_norm;
  a.are_parameters_good = crc32_of_parameters(block, surge_lines, surge_count, yaw_lines, yaw_count,
                                              rest, observer) == crc;
  return a.are_parameters_good;
}

/// Follows these points from the next step on. With no points, holds the reference heading again.
template <class G, class P>
void follow_waypoints(Autopilot<G, P>& a, const Waypoints<float>& waypoints) {
  a.waypoints = waypoints;
  a.acceptance_m2 = waypoints.acceptance_m * waypoints.acceptance_m;
  a.is_leg_started = false;
  switch_off(part_of<typename P::Line>(a));
  switch_off(part_of<typename P::Path>(a));
}

/// Follows this line from the next step on.
template <class G, class P>
void follow_line(Autopilot<G, P>& a, const Polyline<float>& line) {
  follow_waypoints(a, Waypoints<float>{0, 0, 0.0F, false});
  LineFollower& part = part_of<LineFollower>(a);
  part.line = line;
  part.is_started = false;
}

/// Follows this path from the next step on; that step is the path's t = 0.
template <class G, class P>
void follow_path(Autopilot<G, P>& a, const Lissajous<float>& path, float gain_per_s) {
  follow_waypoints(a, Waypoints<float>{0, 0, 0.0F, false});
  PathFollower& part = part_of<PathFollower>(a);
  part.path = path;
  part.gain_per_s = gain_per_s;
  part.is_on = true;
  part.is_started = false;
}

/// Avoids `count` obstacles from the next step on; 0: none. `sectors` has room for `count`
/// elements.
template <class G, class P>
void avoid_obstacles(Autopilot<G, P>& a, const Avoidance<float>& avoidance,
                     const Obstacle<float>* obstacles, Sector<float>* sectors, int count) {
  Avoider& part = part_of<Avoider>(a);
  part.avoidance = avoidance;
  part.obstacles = obstacles;
  part.sectors = sectors;
  part.count = count;
  part.state = AvoidanceState();
}

/// Shapes the heading reference from the next step on, starting from the vehicle's heading.
template <class G, class P>
void shape_headings(Autopilot<G, P>& a, const HeadingShaping<float>& filter, float sample_time_s) {
  Shaper& part = part_of<Shaper>(a);
  part.filter = filter;
  part.sample_time_s = sample_time_s;
  part.is_on = true;
  part.is_started = false;
}

/// Estimates the disturbance from the next step on, starting from 0.
template <class G, class P>
void observe_disturbance(Autopilot<G, P>& a, const Observers<float>& observers,
                         float sample_time_s) {
  Observer& part = part_of<Observer>(a);
  part.observers = observers;
  part.sample_time_s = sample_time_s;
  part.is_on = true;
  part.is_started = false;
}

namespace detail {

/// Maximum magnitude of a position coordinate, m: its square cannot overflow.
constexpr float kPositionMax = 1e6F;

/// kFaultStepLate if too much time has passed since the last step; the first step has no
/// predecessor.
template <class G, class P>
AWMR_INLINE uint8_t check_period(Autopilot<G, P>& a, uint32_t now_ms) {
  const bool late = a.has_stepped && is_older(now_ms, a.last_step_ms, a.limits.step_timeout_ms);
  a.last_step_ms = now_ms;
  a.has_stepped = true;
  return late ? kFaultStepLate : kFaultNone;
}

/// Faults of one step's input.
template <class G, class P>
AWMR_INLINE uint8_t check_input(Autopilot<G, P>& a, const AutopilotInput& in) {
  unsigned fault = a.are_parameters_good ? kFaultNone : kFaultParameters;
  if (in.mode > static_cast<uint8_t>(YawMode::kCombined)) fault |= kFaultRange;
  if (!P::kIsDirected && in.speed_unsigned != 0) fault |= kFaultRange;
  fault |= check_measurement(a.limits, in.measured);
  fault |= check_reference(a.limits, in.reference);
  fault |= check_times(a.limits, in.times);
  fault |= check_period(a, in.times.now_ms);
  if (a.waypoints.count > 0 || in.speed_unsigned != 0 ||
      needs_position(part_of<typename P::Line>(a)) ||
      needs_position(part_of<typename P::Path>(a)) ||
      needs_position(part_of<typename P::Avoidance>(a))) {
    fault |= check_magnitude(in.position_m.x_m, kPositionMax);
    fault |= check_magnitude(in.position_m.y_m, kPositionMax);
  }
  return static_cast<uint8_t>(fault);
}

/// Writes the line-of-sight heading to the waypoint into the reference.
template <class G, class P>
AWMR_INLINE void lead_by_waypoints(Autopilot<G, P>& a, const Whereabouts& at, Reference<float>& ref,
                                   Goal& goal) {
  if (!a.is_leg_started) {
    a.progress = start_waypoints(at.position_m, at.measured.psi_rad);
    a.is_leg_started = true;
  }
  const WaypointGuidance<float> guidance = guide_clear(
      part_of<typename P::Avoidance>(a), a.waypoints, a.acceptance_m2, at.position_m, a.progress);
  ref.psi_rad = guidance.psi_rad;
  ref.psi_rate_radps = 0.0F;
  ref.psi_accel_radps2 = 0.0F;
  goal.arrived = guidance.finished;
  goal.target_m = a.waypoints.points_m + (a.progress.next - (guidance.finished ? 1 : 0));
  slow_down(
      part_of<typename P::Arrival>(a), a.progress.next + 1 >= a.waypoints.count,
      [&] { return distance_m(at.position_m, *goal.target_m); }, ref);
}

/// Updates the reference: guidance by waypoints, line or path, then obstacle avoidance and heading
/// shaping. Returns true when the route is finished.
template <class G, class P>
AWMR_INLINE bool lead_all(Autopilot<G, P>& a, const Whereabouts& at, Reference<float>& ref) {
  Goal goal = {0, false};
  if (a.waypoints.count > 0) {
    lead_by_waypoints(a, at, ref, goal);
  } else if (!lead(part_of<typename P::Line>(a), part_of<typename P::Arrival>(a), at, ref, goal)) {
    lead(part_of<typename P::Path>(a), at, ref);
  }
  steer_clear(part_of<typename P::Avoidance>(a), at, goal, ref);
  shape_heading(part_of<typename P::Shaping>(a), at, ref);
  return goal.arrived;
}

/// Predicts the vehicle's speed by the model between two steps, for a speed without a sign.
template <class G, class P>
AWMR_CALLED void predict_direction(Autopilot<G, P>& a, uint32_t now_ms) {
  if (!a.has_stepped) return;
  const uint32_t wait_ms = now_ms - a.last_step_ms;
  const uint32_t most_ms = a.limits.step_timeout_ms;
  const float dt_s = 0.001F * static_cast<float>(wait_ms < most_ms ? wait_ms : most_ms);
  predict_speed(a.direction, a.controller.surge, a.mass_inverse, a.limits.speed_max_mps, dt_s);
}

/// Gives the measured speed its sign; see apply_direction().
template <class G, class P>
AWMR_CALLED void direct(Autopilot<G, P>& a, const AutopilotInput& in, Measurement<float>& measured,
                        Reference<float>& ref) {
  const bool is_new = !a.direction.has_fix || in.times.speed_ms != a.direction_ms;
  a.direction_ms = in.times.speed_ms;
  correct_speed(a.direction, {measured.u_mps, in.position_m, measured.psi_rad, is_new});
  apply_direction(a.direction, measured, ref);
}

/// True if the reference and both laws are finite. The command alone cannot show this: in steering
/// mode the wheels are straight while the vehicle brakes, even if the reference is NaN.
inline bool is_finite(const AutopilotOutput& out) {
  const uint16_t infinity = static_cast<uint16_t>(float_math::kInfinityBits >> 16U);
  return float_math::leading_bits(out.psi_ref_rad) < infinity &&
         float_math::leading_bits(out.tau_turn_m) < infinity &&
         float_math::leading_bits(out.tau_speed) < infinity;
}

/// Force applied until the next step: the law's, limited to the range of four wheels.
inline float acting_force(const AllocationConstants<float>& c, float tau_speed) {
  return math::clamp(tau_speed, c.tau_speed_min, c.tau_speed_max);
}

/// Computes both laws, the allocation and the motor drives for a reference.
template <class G, class P>
AWMR_INLINE void control(Autopilot<G, P>& a, const AutopilotInput& in,
                         const Measurement<float>& measured, const Reference<float>& ref,
                         AutopilotOutput& out) {
  out.psi_ref_rad = ref.psi_rad;
  out.tau_speed = speed_law(a.controller, measured, ref);
  out.tau_turn_m = heading_law(a.controller, measured, ref);
  const auto& motors = part_of<typename P::Motors>(a);
  const AllocationConstants<float>& at_rest = a.controller.constants.allocation;
  const AllocationConstants<float>& limits = limits_at(motors, at_rest, measured.u_mps);
  allocate_asked(part_of<typename P::Observation>(a), a.controller, static_cast<YawMode>(in.mode),
                 P::kSplit, measured, {limits, out.tau_speed, out.tau_turn_m, out.command});
  make_up_back_emf(motors, at_rest, measured, out.command.force);
}

}  // namespace detail

/// Performs one step. Call it once per sample time. On a fault of the input or of the command, the
/// motors are off and the wheels straight, and `out.fault` has the reason.
template <class G, class P>
void autopilot_step(Autopilot<G, P>& a, const AutopilotInput& in, AutopilotOutput& out) {
  out.arrived = false;
  const bool is_directed = P::kIsDirected && in.speed_unsigned != 0;
  if (is_directed) detail::predict_direction(a, in.times.now_ms);
  if (P::kIsDirected) a.direction.tau_speed = 0.0F;
  out.fault = detail::check_input(a, in);
  if (out.fault == kFaultNone) {
    Reference<float> ref = in.reference;
    out.arrived = detail::lead_all(a, {in.position_m, in.measured, in.times.now_ms}, ref);
    Measurement<float> directed;
    const Measurement<float>* measured = &in.measured;
    if (is_directed) {
      directed = in.measured;
      detail::direct(a, in, directed, ref);
      measured = &directed;
    }
    detail::control(a, in, *measured, ref, out);
    if (detail::is_finite(out) &&
        is_within_limits(a.controller.constants.allocation, out.command)) {
      if (is_directed) {
        a.direction.tau_speed =
            detail::acting_force(a.controller.constants.allocation, out.tau_speed);
      }
      make_up_dead_zone(part_of<typename P::Motors>(a), out.command.force);
      return;
    }
    out.fault = kFaultOutput;
  }
  begin_anew(part_of<typename P::Avoidance>(a));
  begin_anew(part_of<typename P::Shaping>(a));
  begin_anew(part_of<typename P::Observation>(a));
  out.command = safe_command<float>();
  out.tau_speed = 0.0F;
  out.tau_turn_m = 0.0F;
  out.psi_ref_rad = 0.0F;
}

}  // namespace awmr
