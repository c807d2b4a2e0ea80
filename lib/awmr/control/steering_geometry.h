/// Steering angle and wheel forces as functions of q.
///
/// q is a measure of the steering angle d_r. k is the force share: the forces of a left and a right
/// wheel add up to 2 k tau_speed. The left column defines q and k (l_f: centre of gravity to front
/// axle). With four driven wheels, the right column follows from (41) in model/dynamics.h:
///   tau_steering = l_f tau_speed q       q = sin d_r/(1 + cos d_r) = tan(d_r/2)
///   F'L + F'R    = 2 k tau_speed         k = 1/(2 (1 + cos d_r))   = (1 + q^2)/4
/// If only the front wheels are driven (front_wheel_forces() in model/dynamics.h):
///   q = tan d_r,   k = 1/(2 cos d_r) = sqrt(1 + q^2)/2
/// The small-angle form assumes sin d_r = d_r and cos d_r = 1. With four driven wheels, it gives q
/// = d_r/2 and k = 1/4; with two, q = d_r and k = 1/2.
#pragma once

#include "awmr/model/allocation_form.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// q = tan(angle/2) = sin(angle)/(1 + cos(angle)), |angle| < pi.
template <class T>
T tan_half(const T& angle_rad) {
  using math::cos;
  using math::sin;
  return sin(angle_rad) / (T(1.0) + cos(angle_rad));
}

/// Driven wheels, and form of the equations (exact, or for small angles).
struct SteeringGeometry {
  bool is_rear_driven;  ///< false: only the front wheels are driven
  AllocationForm form;  ///< kPaper: for small angles

  /// Number n of driven wheels. Straight ahead, tau_speed = n F' with the force F' of each wheel.
  constexpr double driven_wheels() const { return is_rear_driven ? 4.0 : 2.0; }

  template <class T>
  T to_q(const T& angle_rad) const {
    using math::cos;
    using math::sin;
    if (form == AllocationForm::kPaper) return is_rear_driven ? T(0.5) * angle_rad : angle_rad;
    return is_rear_driven ? tan_half(angle_rad) : T(sin(angle_rad) / cos(angle_rad));
  }
  template <class T>
  AWMR_NO_CALL T to_angle_rad(const T& q) const {
    using math::atan;
    if (form == AllocationForm::kPaper) return is_rear_driven ? T(2.0) * q : q;
    return is_rear_driven ? math::twice_atan(q) : T(atan(q));
  }
  template <class T>
  AWMR_NO_CALL T to_force_share(const T& q) const {
    using math::sqrt;
    if (form == AllocationForm::kPaper) return T(is_rear_driven ? 0.25 : 0.5);
    return is_rear_driven ? T(0.25) * (T(1.0) + q * q) : T(0.5) * sqrt(T(1.0) + q * q);
  }
};

/// The geometry that the firmware supports.
constexpr SteeringGeometry kFourWheelSteering = {true, AllocationForm::kExact};

}  // namespace awmr
