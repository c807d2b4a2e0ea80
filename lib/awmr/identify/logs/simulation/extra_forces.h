/// Forces that a log fit can find, but that the model does not contain: Stribeck friction, the
/// slope of the ground, additional resistance in turns or backward, a centre of gravity ahead of
/// the axle, and motors whose force differs when they brake or drive backward. Private to
/// identify/.
///
/// Stribeck friction is the part of the friction at low speed that exceeds the Coulomb friction c.
/// Its size is s and its speed scale w_s. The resistance g(w) at the speed or yaw rate w becomes
///
///     g(w) + s exp(-(w/w_s)^2) sgn w,   at rest up to c + s
///
/// On a slope, gravity accelerates the vehicle by a constant vector (p_x, p_y) in world
/// coordinates. With the heading psi, the rates of the surge speed u and the sway speed v change by
///
///     u_dot += p_x cos psi + p_y sin psi,   v_dot += p_y cos psi - p_x sin psi
///
/// In turns, the scrub of tyres or tracks increases the surge resistance g1(u). With the yaw rate r
/// and the fitted numbers k, p and q, it becomes
///
///     g1(u) + k |r|^p |u|^q sgn u
///
/// Driving backward, g1 is 1 + e_g times as large as forward.
///
/// A dragging brake, or a wheel that is out of line, pulls a driving vehicle to one side by a yaw
/// moment M (over F_max, m; positive to the left when driving forward):
///
///     r_dot += M/I'z sgn u,   near rest M/I'z u/w_0 with a small speed w_0
///
/// If the centre of gravity lies x_c ahead of the driven axle, whose wheels do not slide sideways,
/// the masses m' and I'z (about the middle of the axle) move by
///
///     u_dot += x_c r^2,   r_dot -= x_c u r m'/I'z
///
/// A wheel force against the motion is 1 + e_b times its command, and a negative (backward) wheel
/// force 1 + e_r times. e_b is called the excess of braking forces, e_r that of backward forces. If
/// left and right commands differ in the log, "the motion" is that of the wheel's side: u - d r
/// (left) or u + d r (right), with half of the track width d. Otherwise it is that of the vehicle,
/// u. Near rest, the effect of e_b decreases linearly to 0 (scale_by_excess() in extra_rates.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace awmr {

/// Numbers of these forces that a fit can estimate (symbols: see above), in the order of
/// kExtraForceNames (model/log_term_names.h).
enum class ExtraForce {
  kSurgeStribeck,          ///< size s of the friction of the speed, over F_max
  kSurgeStribeckSpeed,     ///< w_s, m/s
  kYawStribeck,            ///< size s of the friction of the yaw rate, over F_max, m
  kYawStribeckSpeed,       ///< w_s, rad/s
  kSlopeX,                 ///< p_x, m/s^2
  kSlopeY,                 ///< p_y, m/s^2
  kTurnDrag,               ///< size k over F_max, (s/rad)^p (s/m)^q
  kTurnDragExponent,       ///< p
  kTurnDragSpeedExponent,  ///< q
  kBrakeForce,             ///< e_b
  kReverseForce,           ///< e_r
  kBackwardDrag,           ///< e_g
  kSidePull,               ///< M, m
  kAxleOffset              ///< x_c, m
};
inline constexpr std::size_t kExtraForceCount = 14;

/// A number that the fit estimates, and its column: its index among the unknowns of the fit
/// (linear_stepper.h).
struct ExtraColumn {
  ExtraForce force;
  std::size_t column;
  double factor;  ///< d quantity / d coordinate
};

/// Values of all numbers at one point of a search, and the columns of those that the fit estimates.
struct ExtraForces {
  std::array<double, kExtraForceCount> values{0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0,
                                              1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  std::vector<ExtraColumn> columns{};
  bool has_motor_per_side = false;  ///< true: left and right commands differ in the logs

  double operator[](ExtraForce force) const { return values[static_cast<std::size_t>(force)]; }
  double& operator[](ExtraForce force) { return values[static_cast<std::size_t>(force)]; }
};

}  // namespace awmr
