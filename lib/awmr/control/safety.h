/// Input checks of the autopilot and the safe command. Freestanding C++14.
#pragma once

#include <stdint.h>

#include "awmr/control/allocation_limits.h"
#include "awmr/control/flash.h"
#include "awmr/control/measurement.h"
#include "awmr/control/safety_fault.h"

namespace awmr {

/// Times of the last updates, in ms of one clock that can wrap.
struct InputTimes {
  uint32_t now_ms;      ///< the time of this step
  uint32_t heading_ms;  ///< when heading and yaw rate were measured
  uint32_t speed_ms;    ///< when speed and, if used, position were measured
  uint32_t command_ms;  ///< when the last reference arrived
};

/// Limits of valid input. Part of ParameterBlock, so it has only 32-bit members.
struct SafetyLimits {
  float speed_max_mps;          ///< a measured |u| or |v|, or a |u_d|, above it is invalid
  float yaw_rate_max_radps;     ///< a measured |r| above it is invalid
  uint32_t heading_timeout_ms;  ///< maximum age of heading and yaw rate
  uint32_t speed_timeout_ms;    ///< maximum age of speed and position
  uint32_t command_timeout_ms;  ///< maximum age of the reference
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

/// Returns kFaultNotFinite if the value is infinite or NaN, kFaultRange if |value| > largest, else
/// kFaultNone. The bits are compared as integers, which have the order of the magnitudes. On the
/// chip this takes a tenth of the time of a float comparison.
AWMR_SHARED inline uint8_t check_magnitude_at_edge(float value, float largest) {
  const uint32_t magnitude = float_math::magnitude_bits(value);
  if (magnitude >= float_math::kInfinityBits) return kFaultNotFinite;
  return magnitude > bits_of(largest) ? kFaultRange : kFaultNone;
}
/// Same result as check_magnitude_at_edge(). Usually the leading 16 bits decide, which is faster.
inline uint8_t check_magnitude(float value, float largest) {
  if (float_math::leading_bits(value) < float_math::leading_bits(largest)) return kFaultNone;
  return check_magnitude_at_edge(value, largest);
}

/// True if `then_ms` is more than `limit_ms` before `now_ms`, also when the clock has wrapped to 0
/// in between. A time after `now_ms` is an error and counts as old.
inline bool is_older(uint32_t now_ms, uint32_t then_ms, uint32_t limit_ms) {
  return static_cast<uint32_t>(now_ms - then_ms) > limit_ms;
}

}  // namespace detail

/// Largest yaw rate (rad/s), yaw acceleration (rad/s^2) and acceleration (m/s^2) of a reference.
/// The value is far above that of any vehicle and only prevents overflow of products.
constexpr float kReferenceMax = 1e6F;

/// Faults of a measurement: a value that is not finite or out of range.
inline uint8_t check_measurement(const SafetyLimits& limits, const Measurement<float>& m) {
  return static_cast<uint8_t>(detail::check_magnitude(m.psi_rad, 0.5F * float_math::kAngleMax) |
                              detail::check_magnitude(m.u_mps, limits.speed_max_mps) |
                              detail::check_magnitude(m.v_mps, limits.speed_max_mps) |
                              detail::check_magnitude(m.r_radps, limits.yaw_rate_max_radps));
}

/// Faults of a reference: a value that is not finite or out of range. Measured and desired headings
/// are each limited to half of kAngleMax, so that their difference can be wrapped.
inline uint8_t check_reference(const SafetyLimits& limits, const Reference<float>& ref) {
  return static_cast<uint8_t>(detail::check_magnitude(ref.psi_rad, 0.5F * float_math::kAngleMax) |
                              detail::check_magnitude(ref.psi_rate_radps, kReferenceMax) |
                              detail::check_magnitude(ref.psi_accel_radps2, kReferenceMax) |
                              detail::check_magnitude(ref.speed_mps, limits.speed_max_mps) |
                              detail::check_magnitude(ref.accel_mps2, kReferenceMax));
}

/// Faults of inputs that were not updated in time.
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

/// Final check of a command before it is given to motors and servo: true if both wheel forces and
/// the steering angle are within their limits; false for NaN.
inline bool is_within_limits(const AllocationConstants<float>& c, const Allocation<float>& a) {
  return detail::is_between(a.force.left, c.force_min, c.force_max) &&
         detail::is_between(a.force.right, c.force_min, c.force_max) &&
         detail::check_magnitude(a.steering_rad, c.steering_max_rad) == kFaultNone;
}

}  // namespace awmr
