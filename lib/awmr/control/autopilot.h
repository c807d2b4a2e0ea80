/// One whole step of the firmware: checks, guidance, heading and speed laws, allocation, limits.
/// Freestanding C++14. The host's float run is this source too, and gives the same bits.
#pragma once

#include <stdint.h>

#include "awmr/control/controller.h"
#include "awmr/control/guidance.h"
#include "awmr/control/parameters_block.h"
#include "awmr/control/resistance_table.h"
#include "awmr/control/safety.h"

namespace awmr {

/// What the firmware knows at one step.
struct AutopilotInput {
  uint8_t mode;                 ///< a YawMode
  Measurement<float> measured;  ///< the vehicle's motion, as the sensors say
  Position<float> position_m;   ///< read while following waypoints only
  Reference<float> reference;   ///< its heading is not read while following waypoints
  InputTimes times;             ///< how old all of this is
};

/// What the firmware does at one step.
struct AutopilotOutput {
  Allocation<float> command;  ///< to the motors and the servo
  float tau_speed;            ///< asked for by the speed law, dimensionless; 0 on a fault
  float tau_turn_m;           ///< asked for by the heading law, m; 0 on a fault
  float psi_ref_rad;          ///< the heading held or led to
  bool arrived;               ///< no waypoint is left
  uint8_t fault;              ///< SafetyFault bits; not 0: `command` is the safe one
};

/// The autopilot between two steps. G is ResistanceTable or Resistance<float>.
template <class G>
struct Autopilot {
  PreparedController<float, G> controller;
  SafetyLimits limits;
  Waypoints<float> waypoints;        ///< count 0: none to follow
  float acceptance_m2;               ///< the square of waypoints.acceptance_m
  WaypointProgress<float> progress;  ///< valid once is_leg_started
  uint32_t last_step_ms;             ///< valid once has_stepped
  bool has_stepped;                  ///< a step was made since the start
  bool is_leg_started;               ///< the first step towards the waypoints was made
  bool are_parameters_good;          ///< the check sum was right at the start
};

/// The resistance in the form that the firmware was compiled for: from the block's table, or from
/// the block's alpha and beta.
inline void set_resistance(const TableShape* shape, const float* /*alpha_beta*/,
                           const ResistanceLine* lines, ResistanceTable& table) {
  TableShape read;
  read_flash(shape, read);
  table.lines = lines;
  table.count = static_cast<uint16_t>(read.count);
  table.first = static_cast<uint16_t>(read.first);
  table.mantissa_bits = static_cast<uint8_t>(read.mantissa_bits);
}
inline void set_resistance(const TableShape* /*shape*/, const float* alpha_beta,
                           const ResistanceLine* /*lines*/, Resistance<float>& law) {
  law.alpha = flash_float(alpha_beta);
  law.beta = flash_float(alpha_beta + 1);
  law.rest_speed = 0.0F;
}

/// Reads the parameters and checks them against `crc`, the check sum that they were emitted with.
/// Where they differ it returns false, and every step from then on gives the safe command only. On
/// an AVR the block and the lines lie in flash.
template <class G>
bool start_autopilot(Autopilot<G>& a, const ParameterBlock* block,
                     const ResistanceLine* surge_lines, size_t surge_count,
                     const ResistanceLine* yaw_lines, size_t yaw_count, uint32_t crc) {
  PreparedController<float, G>& c = a.controller;
  read_flash(&block->constants, c.constants);
  set_resistance(&block->surge_table, block->surge_alpha_beta, surge_lines, c.surge);
  set_resistance(&block->yaw_table, block->yaw_alpha_beta, yaw_lines, c.yaw);
  read_flash(&block->safety, a.limits);
  a.waypoints.count = 0;
  a.has_stepped = false;
  a.are_parameters_good =
      crc32_of_parameters(block, surge_lines, surge_count, yaw_lines, yaw_count) == crc;
  return a.are_parameters_good;
}

/// Follows these points from the next step on. With no points it holds the reference's heading
/// again.
template <class G>
void follow_waypoints(Autopilot<G>& a, const Waypoints<float>& waypoints) {
  a.waypoints = waypoints;
  a.acceptance_m2 = waypoints.acceptance_m * waypoints.acceptance_m;
  a.is_leg_started = false;
}

namespace detail {

/// Positions may be this far from the origin, m: their squares are far from overflow.
constexpr float kPositionMax = 1e6F;

/// kFaultStepLate where the step before was too long ago; the first step has none before it.
template <class G>
AWMR_INLINE uint8_t check_period(Autopilot<G>& a, uint32_t now_ms) {
  const bool late = a.has_stepped && is_older(now_ms, a.last_step_ms, a.limits.step_timeout_ms);
  a.last_step_ms = now_ms;
  a.has_stepped = true;
  return late ? kFaultStepLate : kFaultNone;
}

/// The faults of one step's input.
template <class G>
AWMR_INLINE uint8_t check_input(Autopilot<G>& a, const AutopilotInput& in) {
  unsigned fault = a.are_parameters_good ? kFaultNone : kFaultParameters;
  if (in.mode > static_cast<uint8_t>(YawMode::kCombined)) fault |= kFaultRange;
  fault |= check_measurement(a.limits, in.measured);
  fault |= check_reference(a.limits, in.reference);
  fault |= check_times(a.limits, in.times);
  fault |= check_period(a, in.times.now_ms);
  if (a.waypoints.count > 0) {
    fault |= check_magnitude(in.position_m.x_m, kPositionMax);
    fault |= check_magnitude(in.position_m.y_m, kPositionMax);
  }
  return static_cast<uint8_t>(fault);
}

/// The heading that the waypoints lead to.
template <class G>
AWMR_INLINE float led(Autopilot<G>& a, const AutopilotInput& in, bool& arrived) {
  if (!a.is_leg_started) {
    a.progress = start_waypoints(in.position_m, in.measured.psi_rad);
    a.is_leg_started = true;
  }
  const WaypointGuidance<float> guidance =
      guide(a.waypoints, a.acceptance_m2, in.position_m, a.progress);
  arrived = guidance.finished;
  return guidance.psi_rad;
}

/// The laws and the allocation for a reference.
template <class G>
AWMR_INLINE void control(Autopilot<G>& a, const AutopilotInput& in, const Reference<float>& ref,
                         AutopilotOutput& out) {
  out.psi_ref_rad = ref.psi_rad;
  out.tau_speed = speed_law(a.controller, in.measured, ref);
  out.tau_turn_m = heading_law(a.controller, in.measured, ref);
  allocate(static_cast<YawMode>(in.mode), out.tau_speed, out.tau_turn_m,
           a.controller.constants.allocation, CombinedSplit::kRedistribute, out.command);
}

}  // namespace detail

/// One step, to be called once per sample time. On a fault, of the input or of the command, the
/// motors are commanded off and the wheels straight, and `out.fault` tells why.
template <class G>
void autopilot_step(Autopilot<G>& a, const AutopilotInput& in, AutopilotOutput& out) {
  out.arrived = false;
  out.fault = detail::check_input(a, in);
  if (out.fault == kFaultNone) {
    Reference<float> ref = in.reference;
    if (a.waypoints.count > 0) {
      ref.psi_rad = detail::led(a, in, out.arrived);
      ref.psi_rate_radps = 0.0F;
      ref.psi_accel_radps2 = 0.0F;
    }
    detail::control(a, in, ref, out);
    if (is_within_limits(a.controller.constants.allocation, out.command)) return;
    out.fault = kFaultOutput;
  }
  out.command = safe_command<float>();
  out.tau_speed = 0.0F;
  out.tau_turn_m = 0.0F;
  out.psi_ref_rad = 0.0F;
}

}  // namespace awmr
