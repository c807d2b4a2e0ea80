/// Optional parts of a firmware: disturbance observer, gains by mode, position estimate, and the
/// list of all parts. The parts of the guidance are in guidance/parts.h, that of the motors in
/// motor_curve.h.
#pragma once

#include <stdint.h>

#include "awmr/control/autopilot_signals.h"
#include "awmr/control/control_step.h"
#include "awmr/control/flash.h"
#include "awmr/control/guidance/parts.h"
#include "awmr/control/motor_curve.h"
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

  /// Estimates the disturbance from the next step on. The first estimate is 0.
  void enable(const Observers<float>& tuned, float time_s) {
    observers = tuned;
    sample_time_s = time_s;
    is_on = true;
    is_started = false;
  }
  void disable() { is_on = false; }
  void reset() { is_started = false; }
  /// Enables the observer with these parameters. Null: disables it.
  void start(const ObserverBlock* tuned) {
    disable();
    if (tuned == 0) return;
    ObserverBlock read;
    read_flash(tuned, read);
    enable({{read.bandwidth_radps, read.yaw_max_m}, {read.bandwidth_radps, read.surge_max}, true},
           read.sample_time_s);
  }
};

/// Uses other gains in each mode.
struct GainsByMode {
  const ModeGainsBlock* gains;  ///< in flash on an AVR. Null: the same gains in every mode
  uint8_t mode;                 ///< YawMode whose gains are in use; kYawModeCount: none yet

  void start(const ModeGainsBlock* block) {
    gains = block;
    mode = kYawModeCount;
  }
};

/// Estimates the position from the fixes of a GPS receiver. `Filter` is the type of the constants,
/// see PositionEstimate.
template <class Filter = PositionFilter<float>>
struct Positioner {
  static constexpr bool kIsIn = true;
  PositionEstimate<float, Filter> estimate{};
  uint32_t fix_ms = 0;  ///< time of the last fix (AutopilotInput::fix_ms)

  AWMR_INLINE void reset() { estimate.restart(); }
};

/// List of all parts. `split` determines how combined mode distributes the yaw moment when an
/// actuator is at its limit. A firmware without some parts defines its own struct with the same
/// member names, and with Disabled<Part> for each of them.
template <CombinedSplit split = CombinedSplit::kRedistribute>
struct AllParts {
  typedef LineFollower<float> Line;
  typedef PathFollower<float, uint32_t> Path;
  typedef SlowDown<float> Arrival;
  typedef Avoider<float> Avoidance;
  typedef Shaper<float> Shaping;
  typedef Observer Observation;
  typedef MotorCurve Motors;
  typedef GainsByMode Gains;
  typedef Positioner<> Positioning;
  static constexpr CombinedSplit kSplit = split;
  /// True: speed sensors without a sign are supported (AutopilotInput::speed_unsigned).
  static constexpr bool kIsDirected = true;
};

/// Returns the present position: the estimate, or in.position_m if this is not a GPS fix or if the
/// estimate is not compiled in. If the speed sensor measures no sign, the estimate uses the sign of
/// the predicted speed `speed_mps`. Call it only if the input has no fault other than the command
/// time-out.
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

/// Switches to the observer of a mode, or off if the mode has none. No-op if the observer is not
/// compiled in.
inline void use_observer(const GainsBlock&, float, Disabled<Observer>&) {}
inline void use_observer(const GainsBlock& own, float sample_time_s, Observer& part) {
  part.disable();
  if (!(own.observer_radps > 0.0F)) return;
  part.enable({{own.observer_radps, own.observer_yaw_max_m},
               {own.observer_radps, own.observer_surge_max},
               true},
              sample_time_s);
}

/// If the mode has changed, replaces the gains in `constants` and the observer by the gains and
/// observer of `mode`. No-op if GainsByMode is not compiled in.
template <class Observation>
AWMR_INLINE void use_gains(Disabled<GainsByMode>&, uint8_t, ControlConstants<float>&,
                           Observation&) {}
template <class Observation>
void use_gains(GainsByMode& part, uint8_t mode, ControlConstants<float>& constants,
               Observation& observation) {
  if (mode == part.mode) return;
  part.mode = mode;
  if (part.gains == 0) return;
  GainsBlock own;
  read_flash(&part.gains->in[mode], own);
  constants.laws = own.laws;
  const float sample_time_s = flash_float(&part.gains->observer_sample_time_s);
  if (sample_time_s > 0.0F) use_observer(own, sample_time_s, observation);
}

/// Computes the commands for the outputs of the control laws. If the disturbance observer is
/// compiled in and on, its estimate is subtracted from these outputs first.
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
