/// Forces that a log fit can find, but that the model does not contain: Stribeck friction and the
/// slope of the ground. Private to identify/.
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
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace awmr {

/// Quantities of these forces, in the order of kExtraForceNames (model/log_term_names.h).
enum class ExtraForce {
  kSurgeStribeck,       ///< s over F_max, of the speed
  kSurgeStribeckSpeed,  ///< w_s, m/s
  kYawStribeck,         ///< s over F_max, m, of the yaw rate
  kYawStribeckSpeed,    ///< w_s, rad/s
  kSlopeX,              ///< p_x, m/s^2
  kSlopeY               ///< p_y, m/s^2
};
inline constexpr std::size_t kExtraForceCount = 6;

/// A free quantity of these forces and the column of its derivatives.
struct ExtraColumn {
  ExtraForce force;
  std::size_t column;
  double factor;  ///< d quantity / d coordinate
};

/// The forces at one point of a search, with their free quantities.
struct ExtraForces {
  std::array<double, kExtraForceCount> values{0.0, 1.0, 0.0, 1.0, 0.0, 0.0};
  std::vector<ExtraColumn> columns{};

  double operator[](ExtraForce force) const { return values[static_cast<std::size_t>(force)]; }
  double& operator[](ExtraForce force) { return values[static_cast<std::size_t>(force)]; }
};

}  // namespace awmr
