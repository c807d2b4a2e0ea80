/// One complete step of the firmware: measurement -> checks -> guidance -> laws -> observer ->
/// allocation -> limits -> command. A simulation in float on the host compiles the same source,
/// with bit-identical results.
#pragma once

#include <stdint.h>

#include "awmr/control/autopilot_signals.h"
#include "awmr/control/autopilot_state.h"
#include "awmr/control/control_step.h"
#include "awmr/control/directed_speed.h"
#include "awmr/control/guidance/guidance.h"
#include "awmr/control/safety.h"

namespace awmr {

namespace detail {

/// Maximum magnitude of a position coordinate, m: its square cannot overflow.
constexpr float kPositionMax = 1e6F;

/// Returns kFaultStepLate if more than step_timeout_ms have passed since the last step. The first
/// step is never late.
template <class G, class P>
AWMR_INLINE uint8_t check_period(Autopilot<G, P>& a, uint32_t now_ms) {
  const bool is_late = a.has_stepped && is_older(now_ms, a.last_step_ms, a.limits.step_timeout_ms);
  a.last_step_ms = now_ms;
  a.has_stepped = true;
  return is_late ? kFaultStepLate : kFaultNone;
}

/// Checks the input of one step. Returns SafetyFault bits.
template <class G, class P>
AWMR_INLINE uint8_t check_input(Autopilot<G, P>& a, const AutopilotInput& in) {
  unsigned fault = a.are_parameters_good ? kFaultNone : kFaultParameters;
  if (in.mode > static_cast<uint8_t>(YawMode::kCombined)) fault |= kFaultRange;
  if (!P::kIsDirected && in.speed_unsigned != 0) fault |= kFaultRange;
  if (!P::Positioning::kIsIn && in.position_is_fix != 0) fault |= kFaultRange;
  fault |= check_measurement(a.limits, in.measured);
  fault |= check_reference(a.limits, in.reference);
  fault |= check_times(a.limits, in.times);
  fault |= check_period(a, in.times.now_ms);
  if (in.speed_unsigned != 0 || in.position_is_fix != 0 || guidance_needs_position(a)) {
    fault |= check_magnitude(in.position_m.x_m, kPositionMax);
    fault |= check_magnitude(in.position_m.y_m, kPositionMax);
  }
  return static_cast<uint8_t>(fault);
}

/// Updates the reference by guidance, obstacle avoidance and heading shaping. Returns true when the
/// route is finished.
template <class G, class P>
AWMR_INLINE bool update_reference(Autopilot<G, P>& a, const AutopilotInput& in,
                                  const Position<float>& position_m, Reference<float>& ref) {
  const VehiclePose<float, uint32_t> at = {position_m, in.measured, in.times.now_ms};
  const GuidanceTarget<float> target = guide_by_route(a, at, ref);
  steer_around_obstacles(part_of<typename P::Avoidance>(a), at, target, ref);
  shape_heading(part_of<typename P::Shaping>(a), at, ref);
  return target.arrived;
}

/// For a speed sensor without a sign: predicts the signed speed at this step by the identified
/// model. No-op in the first step.
template <class G, class P>
AWMR_CALLED void predict_direction(Autopilot<G, P>& a, uint32_t now_ms) {
  if (!a.has_stepped) return;
  const uint32_t wait_ms = now_ms - a.last_step_ms;
  const uint32_t most_ms = a.limits.step_timeout_ms;
  const float dt_s = 0.001F * static_cast<float>(wait_ms < most_ms ? wait_ms : most_ms);
  predict_speed(a.direction, a.controller.surge, a.mass_inverse, a.limits.speed_max_mps, dt_s);
}

/// Corrects the predicted speed by a reading of the speed sensor, if the reading is new.
template <class G, class P>
AWMR_CALLED void read_speed(Autopilot<G, P>& a, const AutopilotInput& in) {
  const bool is_new = !a.direction.has_fix || in.times.speed_ms != a.direction_ms;
  a.direction_ms = in.times.speed_ms;
  correct_speed(a.direction, {in.measured.u_mps, in.position_m, in.measured.psi_rad, is_new});
}

/// True if the heading reference and the outputs of both laws are finite. A check of the command
/// alone is not enough: in steering mode, a braking vehicle gets straight wheels even if the
/// heading reference is NaN.
inline bool is_finite(const AutopilotOutput& out) {
  const uint16_t infinity = static_cast<uint16_t>(float_math::kInfinityBits >> 16U);
  return float_math::leading_bits(out.psi_ref_rad) < infinity &&
         float_math::leading_bits(out.tau_turn_m) < infinity &&
         float_math::leading_bits(out.tau_speed) < infinity;
}

/// Computes speed law, heading law, allocation and motor drives for a reference.
template <class G, class P>
AWMR_INLINE void control(Autopilot<G, P>& a, const AutopilotInput& in,
                         const Measurement<float>& measured, const Reference<float>& ref,
                         AutopilotOutput& out) {
  auto& motors = part_of<typename P::Motors>(a);
  use_friction_width(motors, in.mode, a.controller.yaw);
  use_gains(part_of<typename P::Gains>(a), in.mode, a.controller.constants,
            part_of<typename P::Observation>(a));
  out.psi_ref_rad = ref.psi_rad;
  out.tau_speed = speed_law(a.controller, measured, ref);
  out.tau_turn_m = heading_law(a.controller, measured, ref);
  const AllocationConstants<float>& at_rest = a.controller.constants.allocation;
  const float emf_mps = back_emf_speed(motors, a.controller, measured, ref);
  const AllocationConstants<float>& limits = limits_at(motors, at_rest, emf_mps);
  allocate_observed(part_of<typename P::Observation>(a), a.controller, measured,
                    {kFourWheelSteering, yaw_split<float>(static_cast<YawMode>(in.mode), P::kSplit),
                     limits, out.tau_speed, out.tau_turn_m, out.command});
  make_up_back_emf(motors, at_rest, emf_mps, measured.r_radps, out.command.force);
}

/// Sets the safe command (motors off, wheels straight). Resets obstacle avoidance, heading shaping
/// and disturbance observers, because their state no longer matches the motion of the vehicle.
template <class G, class P>
AWMR_INLINE void stop(Autopilot<G, P>& a, AutopilotOutput& out) {
  part_of<typename P::Avoidance>(a).reset();
  part_of<typename P::Shaping>(a).reset();
  part_of<typename P::Observation>(a).reset();
  out.command = safe_command<float>();
  out.tau_speed = 0.0F;
  out.tau_turn_m = 0.0F;
  out.psi_ref_rad = 0.0F;
}

}  // namespace detail

/// Performs one control step. Call it once per sample time. If the input or the computed command
/// has a fault, the motors are off, the wheels straight, and `out.fault` names the fault.
template <class G, class P>
void autopilot_step(Autopilot<G, P>& a, const AutopilotInput& in, AutopilotOutput& out) {
  out.arrived = false;
  const bool is_directed = P::kIsDirected && in.speed_unsigned != 0;
  if (is_directed) detail::predict_direction(a, in.times.now_ms);
  if (P::kIsDirected) a.direction.tau_speed = 0.0F;
  out.fault = detail::check_input(a, in);
  // The estimates of direction and position continue during a command time-out, which is normal
  // before a drive. Any other fault stops them.
  const bool is_sensed = (out.fault & static_cast<uint8_t>(~kFaultCommandTimeout)) == 0;
  if (is_directed && is_sensed) detail::read_speed(a, in);
  typename P::Positioning& positioning = part_of<typename P::Positioning>(a);
  if (!is_sensed) positioning.reset();
  const Position<float>& position_m =
      is_sensed ? position_now(positioning, in, a.direction.predicted_mps) : in.position_m;
  if (out.fault == kFaultNone) {
    Reference<float> ref = in.reference;
    out.arrived = detail::update_reference(a, in, position_m, ref);
    Measurement<float> directed;
    const Measurement<float>* measured = &in.measured;
    if (is_directed) {
      directed = in.measured;
      apply_direction(a.direction, directed, ref);
      measured = &directed;
    }
    detail::control(a, in, *measured, ref, out);
    if (detail::is_finite(out) &&
        is_within_limits(a.controller.constants.allocation, out.command)) {
      if (is_directed) {
        // The force that acts until the next step is limited to the range of the four motors.
        const AllocationConstants<float>& c = a.controller.constants.allocation;
        a.direction.tau_speed = math::clamp(out.tau_speed, c.tau_speed_min, c.tau_speed_max);
      }
      make_up_dead_zone(part_of<typename P::Motors>(a), out.command.force);
      return;
    }
    out.fault = kFaultOutput;
  }
  detail::stop(a, out);
}

}  // namespace awmr
