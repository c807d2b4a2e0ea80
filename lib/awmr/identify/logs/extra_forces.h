/// Forces that a log fit can find, but that the model does not contain: Stribeck friction, the
/// slope of the ground, additional resistance in turns or backward, and motors whose force differs
/// when they brake or drive backward. Private to identify/.
///
/// Stribeck friction is larger at low speed than the Coulomb friction c. At the speed or yaw rate w
/// the resistance is
///
///     g(w) + s exp(-(w/w_s)^2) sgn w,   at rest up to c + s
///
/// On a slope, gravity accelerates the vehicle by a constant vector (p_x, p_y) in world
/// coordinates, with the heading psi:
///
///     u_dot += p_x cos psi + p_y sin psi,   v_dot += p_y cos psi - p_x sin psi
///
/// In turns, the scrub of tyres or tracks increases the surge resistance at the yaw rate r to
///
///     g1(u) + k |r|^p |u|^q sgn u
///
/// Driving backward, g1 is 1 + e_g times as large as forward.
///
/// A wheel force against the motion is 1 + e_b times its command, and a negative (backward) wheel
/// force 1 + e_r times its command. e_b and e_r are called the excess of braking or backward
/// forces. If the left and right commands differ in the log, "the motion" is that of the wheel's
/// side (u - d r left, u + d r right), else that of the vehicle (u). Near rest, the effect of e_b
/// decreases linearly to 0 (scale_by_excess() in extra_rates.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace awmr {

/// Quantities of these forces, in the order of kExtraForceNames (model/log_term_names.h).
enum class ExtraForce {
  kSurgeStribeck,          ///< s over F_max, of the speed
  kSurgeStribeckSpeed,     ///< w_s, m/s
  kYawStribeck,            ///< s over F_max, m, of the yaw rate
  kYawStribeckSpeed,       ///< w_s, rad/s
  kSlopeX,                 ///< p_x, m/s^2
  kSlopeY,                 ///< p_y, m/s^2
  kTurnDrag,               ///< k over F_max, (s/rad)^p (s/m)^q
  kTurnDragExponent,       ///< p
  kTurnDragSpeedExponent,  ///< q
  kBrakeForce,             ///< e_b
  kReverseForce,           ///< e_r
  kBackwardDrag            ///< e_g
};
inline constexpr std::size_t kExtraForceCount = 12;

/// A free quantity of these forces and the column of its derivatives.
struct ExtraColumn {
  ExtraForce force;
  std::size_t column;
  double factor;  ///< d quantity / d coordinate
};

/// The forces at one point of a search, with their free quantities.
struct ExtraForces {
  std::array<double, kExtraForceCount> values{0.0, 1.0, 0.0, 1.0, 0.0, 0.0,
                                              0.0, 1.0, 0.0, 0.0, 0.0, 0.0};
  std::vector<ExtraColumn> columns{};
  bool has_motor_per_side = false;  ///< left and right commands differ

  double operator[](ExtraForce force) const { return values[static_cast<std::size_t>(force)]; }
  double& operator[](ExtraForce force) { return values[static_cast<std::size_t>(force)]; }
};

}  // namespace awmr
