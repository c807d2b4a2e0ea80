/// What the autopilot refuses to steer by, and what it does then. Freestanding C++14.
#pragma once

#include <stdint.h>

#include "awmr/control/allocation.h"
#include "awmr/control/controller.h"
#include "awmr/control/flash.h"
#include "awmr/control/safety_fault.h"

namespace awmr {

/// When things were last renewed, in ms of one clock that may wrap around.
struct InputTimes {
  uint32_t now_ms;      ///< the time of this step
  uint32_t heading_ms;  ///< when heading and yaw rate were measured
  uint32_t speed_ms;    ///< when speed and position were measured
  uint32_t command_ms;  ///< when the reference was given
};

/// What the autopilot still steers by. Part of ParameterBlock, so of 32-bit members only.
struct SafetyLimits {
  float speed_max_mps;          ///< a measured |u| or |v| above it is no measurement
  float yaw_rate_max_radps;     ///< a measured |r| above it is no measurement
  uint32_t heading_timeout_ms;  ///< oldest heading and yaw rate to steer by
  uint32_t speed_timeout_ms;    ///< oldest speed and position to steer by
  uint32_t command_timeout_ms;  ///< longest silence of whoever gives the reference
  uint32_t step_timeout_ms;     ///< longest time between two steps
};

/// The command on a fault: motors off, wheels straight.
template <class T>
Allocation<T> safe_command() {
  Allocation<T> a{};
  a.force = {T(0.0), T(0.0)};
  a.steering_rad = T(0.0);
  return a;
}

namespace detail {

/// kFaultNotFinite where the value is infinite or NaN, kFaultRange where |value| > largest, else
/// kFaultNone. It compares bits, which order as the magnitudes do; on the chip that costs a tenth
/// of a comparison of floats.
AWMR_SHARED inline uint8_t check_magnitude_at_edge(float value, float largest) {
  const uint32_t magnitude = float_math::magnitude_bits(value);
  if (magnitude >= float_math::kInfinityBits) return kFaultNotFinite;
  return magnitude > bits_of(largest) ? kFaultRange : kFaultNone;
}
/// The same, most often by the leading halves alone.
inline uint8_t check_magnitude(float value, float largest) {
  if (float_math::leading_bits(value) < float_math::leading_bits(largest)) return kFaultNone;
  return check_magnitude_at_edge(value, largest);
}

/// True where `then_ms` lies more than `limit_ms` before `now_ms`; the difference is right across
/// the clock's wrap. A time ahead of `now_ms` cannot come from the clock and counts as old.
inline bool is_older(uint32_t now_ms, uint32_t then_ms, uint32_t limit_ms) {
  return static_cast<uint32_t>(now_ms - then_ms) > limit_ms;
}

}  // namespace detail

/// The largest yaw rate (rad/s) and acceleration (rad/s^2, m/s^2) that a reference may ask for. It
/// is far beyond any vehicle, and there only so that no product overflows.
constexpr float kReferenceMax = 1e6F;

/// The faults of a measurement: a value that is not finite or cannot be.
inline uint8_t check_measurement(const SafetyLimits& limits, const Measurement<float>& m) {
  return static_cast<uint8_t>(detail::check_magnitude(m.psi_rad, 0.5F * float_math::kAngleMax) |
                              detail::check_magnitude(m.u_mps, limits.speed_max_mps) |
                              detail::check_magnitude(m.v_mps, limits.speed_max_mps) |
                              detail::check_magnitude(m.r_radps, limits.yaw_rate_max_radps));
}

/// The faults of a reference: a value that is not finite or cannot be. Headings, measured and
/// wanted, may be half of kAngleMax each, so that their difference is an angle that wraps.
inline uint8_t check_reference(const SafetyLimits& limits, const Reference<float>& ref) {
  return static_cast<uint8_t>(detail::check_magnitude(ref.psi_rad, 0.5F * float_math::kAngleMax) |
                              detail::check_magnitude(ref.psi_rate_radps, kReferenceMax) |
                              detail::check_magnitude(ref.psi_accel_radps2, kReferenceMax) |
                              detail::check_magnitude(ref.speed_mps, limits.speed_max_mps) |
                              detail::check_magnitude(ref.accel_mps2, kReferenceMax));
}

/// The faults of inputs that were not renewed in time.
inline uint8_t check_times(const SafetyLimits& limits, const InputTimes& times) {
  unsigned fault = kFaultNone;
  if (detail::is_older(times.now_ms, times.heading_ms, limits.heading_timeout_ms)) {
    fault |= kFaultHeadingStale;
  }
  if (detail::is_older(times.now_ms, times.speed_ms, limits.speed_timeout_ms)) {
    fault |= kFaultSpeedStale;
  }
  if (detail::is_older(times.now_ms, times.command_ms, limits.command_timeout_ms)) {
    fault |= kFaultCommandTimeout;
  }
  return static_cast<uint8_t>(fault);
}

namespace detail {
/// lo <= value <= hi; false for NaN.
inline bool is_between(float value, float lo, float hi) {
  if (float_math::is_inside(value, lo, hi)) return true;
  const int32_t order = float_math::order_of(value);
  return !float_math::is_nan(value) && order >= float_math::order_of(lo) &&
         order <= float_math::order_of(hi);
}
}  // namespace detail

/// The last gate before the motors: every command is a number within its limits. False for NaN.
inline bool is_within_limits(const AllocationConstants<float>& c, const Allocation<float>& a) {
  return detail::is_between(a.force.left, c.force_min, c.force_max) &&
         detail::is_between(a.force.right, c.force_min, c.force_max) &&
         detail::check_magnitude(a.steering_rad, c.steering_max_rad) == kFaultNone;
}

}  // namespace awmr
