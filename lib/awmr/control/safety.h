/// Input checks of the autopilot and the safe command.
#pragma once

#include <stdint.h>

#include "awmr/control/allocation_limits.h"
#include "awmr/control/faults.h"
#include "awmr/control/flash.h"
#include "awmr/control/measurement.h"

namespace awmr {

/// Times of the last updates of the inputs, read from one clock, in ms, that can wrap to 0.
struct InputTimes {
  uint32_t now_ms;      ///< the time of this step
  uint32_t heading_ms;  ///< time at which heading and yaw rate were measured
  uint32_t speed_ms;    ///< time at which speed and, if used, position were measured
  uint32_t command_ms;  ///< time at which the last reference arrived
};

/// Limits of valid input. All members have 32 bits, because the struct is part of ParameterBlock.
struct SafetyLimits {
  float speed_max_mps;          ///< largest valid |u|, |v| (measured) and |u_d| (desired)
  float yaw_rate_max_radps;     ///< largest valid measured yaw rate |r|
  uint32_t heading_timeout_ms;  ///< maximum age of heading and yaw rate
  uint32_t speed_timeout_ms;    ///< maximum age of speed and position
  uint32_t command_timeout_ms;  ///< maximum age of the reference
  uint32_t step_timeout_ms;     ///< maximum time between two control steps
};

/// Returns the command for a step with a fault: motors off, wheels straight.
template <class T>
Allocation<T> safe_command() {
  Allocation<T> a{};
  a.force = {T(0.0), T(0.0)};
  a.steering_rad = T(0.0);
  return a;
}

namespace detail {

/// Returns kFaultNotFinite if the value is infinite or NaN, kFaultRange if |value| > largest, else
/// kFaultNone. The bits of the floats are compared as integers, which have the same order. On the
/// chip, this takes a tenth of the time of a float comparison.
AWMR_SHARED inline uint8_t check_magnitude_at_edge(float value, float largest) {
  const uint32_t magnitude = float_math::magnitude_bits(value);
  if (magnitude >= float_math::kInfinityBits) return kFaultNotFinite;
  return magnitude > bits_of(largest) ? kFaultRange : kFaultNone;
}
/// Returns the same result as check_magnitude_at_edge(), but faster: the leading 16 bits usually
/// decide.
inline uint8_t check_magnitude(float value, float largest) {
  if (float_math::leading_bits(value) < float_math::leading_bits(largest)) return kFaultNone;
  return check_magnitude_at_edge(value, largest);
}

/// True if `then_ms` is more than `limit_ms` before `now_ms`, also if the clock has wrapped to 0 in
/// between. If `then_ms` is after `now_ms`, which is an error, the result is true.
inline bool is_older(uint32_t now_ms, uint32_t then_ms, uint32_t limit_ms) {
  return static_cast<uint32_t>(now_ms - then_ms) > limit_ms;
}

}  // namespace detail

/// Limit of the reference's yaw rate (rad/s), yaw acceleration (rad/s^2) and acceleration (m/s^2).
/// It is far above the values of any vehicle, and only keeps products from overflowing.
constexpr float kReferenceMax = 1e6F;

/// Returns the faults of a measurement: a value is not finite, or out of range.
inline uint8_t check_measurement(const SafetyLimits& limits, const Measurement<float>& m) {
  return static_cast<uint8_t>(detail::check_magnitude(m.psi_rad, 0.5F * float_math::kAngleMax) |
                              detail::check_magnitude(m.u_mps, limits.speed_max_mps) |
                              detail::check_magnitude(m.v_mps, limits.speed_max_mps) |
                              detail::check_magnitude(m.r_radps, limits.yaw_rate_max_radps));
}

/// Returns the faults of a reference: a value is not finite, or out of range. Measured and desired
/// headings are each limited to half of kAngleMax, so that their difference can be wrapped.
inline uint8_t check_reference(const SafetyLimits& limits, const Reference<float>& ref) {
  return static_cast<uint8_t>(detail::check_magnitude(ref.psi_rad, 0.5F * float_math::kAngleMax) |
                              detail::check_magnitude(ref.psi_rate_radps, kReferenceMax) |
                              detail::check_magnitude(ref.psi_accel_radps2, kReferenceMax) |
                              detail::check_magnitude(ref.speed_mps, limits.speed_max_mps) |
                              detail::check_magnitude(ref.accel_mps2, kReferenceMax));
}

/// Returns the faults of the time stamps: an input was not updated in time.
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

/// Final check of a command before it is given to motors and servo. True if both wheel forces and
/// the steering angle are within their limits; false for NaN.
inline bool is_within_limits(const AllocationConstants<float>& c, const Allocation<float>& a) {
  return detail::is_between(a.force.left, c.force_min, c.force_max) &&
         detail::is_between(a.force.right, c.force_min, c.force_max) &&
         detail::check_magnitude(a.steering_rad, c.steering_max_rad) == kFaultNone;
}

}  // namespace awmr
