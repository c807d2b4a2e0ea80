/// Optional parts of a firmware: disturbance observer, compensation of dead zone and back-EMF, and
/// position estimate. The parts of the guidance are in guidance/parts.h. Freestanding C++14.
#pragma once

#include <stdint.h>

#include "awmr/control/autopilot_signals.h"
#include "awmr/control/control_step.h"
#include "awmr/control/flash.h"
#include "awmr/control/guidance/parts.h"
#include "awmr/control/motor_command.h"
#include "awmr/control/optional_part.h"
#include "awmr/control/parameters_block.h"
#include "awmr/control/position_estimate.h"
#include "awmr/control/yaw_mode.h"

namespace awmr {

/// Disturbance observer, whose estimate is subtracted from the requested force and moment.
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
  const RestBlock* rest;   ///< the parameters, in flash on an AVR; null: none of these features
  uint8_t mode;            ///< YawMode for which RestingTable::rest_speed of g3 is set
};

/// Estimates the position from the fixes of a GPS receiver. Filter: see PositionEstimate.
template <class Filter = PositionFilter<float>>
struct Positioner {
  PositionEstimate<float, Filter> estimate{};
  uint32_t fix_ms = 0;  ///< AutopilotInput::fix_ms of the last fix
};

/// List of parts for a firmware without optional parts. A firmware with some parts defines its own
/// struct with these names, such as AllParts below.
struct NoParts {
  typedef Disabled<LineFollower<float>> Line;
  typedef Disabled<PathFollower<float, uint32_t>> Path;
  typedef Disabled<SlowDown<float>> Arrival;
  typedef Disabled<Avoider<float>> Avoidance;
  typedef Disabled<Shaper<float>> Shaping;
  typedef Disabled<Observer> Observation;
  typedef Disabled<MotorCurve> Motors;
  typedef Disabled<Positioner<>> Positioning;
  static constexpr CombinedSplit kSplit = CombinedSplit::kRedistribute;
  static constexpr bool kIsDirected = true;  ///< AutopilotInput::speed_unsigned is supported
};

/// List of all parts, for a firmware with the given split of the combined mode.
template <CombinedSplit split = CombinedSplit::kRedistribute>
struct AllParts {
  typedef LineFollower<float> Line;
  typedef PathFollower<float, uint32_t> Path;
  typedef SlowDown<float> Arrival;
  typedef Avoider<float> Avoidance;
  typedef Shaper<float> Shaping;
  typedef Observer Observation;
  typedef MotorCurve Motors;
  typedef Positioner<> Positioning;
  static constexpr CombinedSplit kSplit = split;
  static constexpr bool kIsDirected = true;
};

/// Makes the part estimate the disturbance from the next step on. The first estimate is 0.
inline void enable(Observer& part, const Observers<float>& observers, float sample_time_s) {
  part.observers = observers;
  part.sample_time_s = sample_time_s;
  part.is_on = true;
  part.is_started = false;
}
inline void disable(Observer& part) { part.is_on = false; }
inline void reset(Observer& part) { part.is_started = false; }

/// True if the position estimate is compiled in.
template <class Filter>
AWMR_INLINE bool estimates_position(const Disabled<Positioner<Filter>>&) {
  return false;
}
template <class Filter>
AWMR_INLINE bool estimates_position(const Positioner<Filter>&) {
  return true;
}

template <class Filter>
AWMR_INLINE void reset(Positioner<Filter>& part) {
  part.estimate.restart();
}

/// Returns the present position: the estimate, or position_m of the input if the part is not
/// compiled in or position_m is not a fix. Call it only if the input has no fault other than the
/// command time-out. `speed_mps`: predicted speed, which gives a measured speed without a sign its
/// sign.
template <class Filter>
AWMR_INLINE const Position<float>& position_now(const Disabled<Positioner<Filter>>&,
                                                const AutopilotInput& in, const float&) {
  return in.position_m;
}
template <class Filter>
AWMR_CALLED Position<float> position_now(Positioner<Filter>& part, const AutopilotInput& in,
                                         const float& speed_mps) {
  if (in.position_is_fix == 0) {
    part.estimate.restart();
    return in.position_m;
  }
  const bool is_new = in.fix_ms != part.fix_ms;
  part.fix_ms = in.fix_ms;
  const float age_s = is_new ? 0.001F * static_cast<float>(in.times.now_ms - in.fix_ms) : 0.0F;
  Measurement<float> motion = in.measured;
  if (in.speed_unsigned != 0) motion.u_mps = math::with_sign(motion.u_mps, speed_mps);
  return part.estimate.step({in.position_m, age_s, is_new}, motion);
}

/// Replaces each force by the motor command that makes this force in spite of the dead zone.
AWMR_INLINE void make_up_dead_zone(const Disabled<MotorCurve>&, SideForces<float>&) {}
inline void make_up_dead_zone(const MotorCurve& part, SideForces<float>& force) {
  force = with_dead_zone(force, part.dead_zone);
}

/// Sets the friction width of g3 to that of the mode, if the mode has changed and MotorCurve is
/// compiled in. The friction width is the yaw rate below which Coulomb friction is fed forward
/// smoothly (Gains::friction_width_at()).
template <class G>
AWMR_INLINE void use_friction_width(Disabled<MotorCurve>&, uint8_t, G&) {}
template <class G>
void use_friction_width(MotorCurve& part, uint8_t mode, G& yaw) {
  if (mode == part.mode) return;
  part.mode = mode;
  if (part.rest != 0) set_friction_width(part.rest, mode, yaw);
}

/// Allocation limits at the speed u, m/s. If MotorCurve is compiled in, back-EMF reduces them.
AWMR_INLINE const AllocationConstants<float>& limits_at(const Disabled<MotorCurve>&,
                                                        const AllocationConstants<float>& c,
                                                        const float& /*u_mps*/) {
  return c;
}
inline AllocationConstants<float> limits_at(const MotorCurve& part,
                                            const AllocationConstants<float>& c,
                                            const float& u_mps) {
  return at_speed(c, part.back_emf_s_per_m, u_mps);
}

/// Replaces each force by the motor drive that makes this force in spite of the back-EMF.
AWMR_INLINE void make_up_back_emf(const Disabled<MotorCurve>&, const AllocationConstants<float>&,
                                  const Measurement<float>&, SideForces<float>&) {}
inline void make_up_back_emf(const MotorCurve& part, const AllocationConstants<float>& c,
                             const Measurement<float>& m, SideForces<float>& force) {
  force = motor_drives(force, c, part.back_emf_s_per_m, m.u_mps, m.r_radps);
}

/// Allocates the outputs of the control laws, minus the estimated disturbance if the observer is
/// compiled in and on.
template <class G>
AWMR_INLINE void allocate_observed(Disabled<Observer>&, const PreparedController<float, G>& c,
                                   const Measurement<float>& m,
                                   const AllocationRequest<float>& request) {
  const Observers<float>* const none = 0;
  ObserversState<float>* const no_state = 0;
  allocate_compensated(none, c, m, 0.0F, request, no_state);
}
template <class G>
void allocate_observed(Observer& part, const PreparedController<float, G>& c,
                       const Measurement<float>& m, const AllocationRequest<float>& request) {
  if (part.is_on && !part.is_started) {
    part.state = start_observers(part.observers, observed_motion(c, m).momentum);
    part.is_started = true;
  }
  allocate_compensated(part.is_on ? &part.observers : 0, c, m, part.sample_time_s, request,
                       &part.state);
}

}  // namespace awmr
