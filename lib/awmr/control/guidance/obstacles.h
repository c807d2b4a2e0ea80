/// Obstacle avoidance: turns the heading commanded by the guidance out of the sectors that circular
/// obstacles block.
///
/// The paper names MMD, D_obs and sigma, but its figure of the algorithm is lost.     [paper 5.2.2]
/// The rule here is the project's own. The vehicle is at the position p with the speed u. For
/// obstacle i with the centre c_i:
///
///   MMD(u)  = mmd_base + mmd_per_speed |u|            minimum manoeuvring distance
///   R_i     = radius_i + vehicle_radius + clearance   grown radius
///   D_i     = |c_i - p|                               distance to the centre
///   D_obs   = D_i - R_i                               distance to the grown circle
///   w_i     = clamp((MMD - D_obs)/MMD, 0, 1)          0 at the distance MMD, 1 at the grown circle
///   alpha_i = asin(R_i/D_i) + sigma w_i               half angle of the blocked sector, D_i > R_i
///           = pi/2          + sigma w_i               the same inside the grown circle
///
/// The blocked sector is centred on the bearing of c_i. An obstacle counts while D_obs <= MMD (plus
/// the hysteresis once avoidance is active) and while it is nearer than the target. If the heading
/// of the guidance is in blocked sectors, the desired heading psi_d is the nearer edge of their
/// union, left or right. The vehicle keeps this side until the other edge is nearer by
/// `side_hysteresis_rad`, or until the heading of the guidance is free again.
///
/// Why this avoids a single obstacle: a vehicle with the turning radius rho heads for the centre of
/// a grown circle of radius R, at the distance D. It can turn past the circle if D^2 >= (R + rho)^2
/// - rho^2. For any R, this is true while D_obs >= rho. So an MMD of rho plus the distance
/// travelled while the turn begins is sufficient.
///
/// With several obstacles, or a start that is too close, this can fail. Therefore, the avoidance
/// also reduces the speed, so that the vehicle stops before a smaller circle, grown by
/// vehicle_radius + clearance/2. The permitted fraction of the reference speed u_d is the distance
/// to that circle along the heading, divided by `brake_m`.
///
/// Edge cases:
///   vehicle inside R_i        the sector is more than a half-plane, so psi_d leads out; a vehicle
///                             that heads further in is stopped
///   vehicle exactly on c_i    the bearing of c_i is taken to be the vehicle's heading
///   every direction blocked   `blocked` is set, u_d becomes 0, psi_d is that of the guidance
///   an obstacle on a waypoint see covers()
#pragma once

#include "awmr/control/guidance/blocked_sectors.h"
#include "awmr/control/guidance/waypoints.h"

namespace awmr {

/// The side to which psi_d is turned.
enum class AvoidanceSide { kNone, kLeft, kRight };

/// State of the avoidance between steps.
struct AvoidanceState {
  /// kNone: no sector blocks the heading of the guidance
  AvoidanceSide side = AvoidanceSide::kNone;
};

/// Heading and speed that avoid the obstacles in one step.
template <class T>
struct Avoided {
  T psi_rad;      ///< psi_d, rad, in (-pi, pi]
  T speed_share;  ///< permitted fraction of the reference speed u_d, in [0, 1]
  /// True: psi_d differs from the heading of the guidance, or every direction is blocked.
  bool active;
  bool blocked;  ///< every direction is blocked
};

/// True if the grown circle of the obstacle contains the whole acceptance circle (radius
/// acceptance_m) of a target. The vehicle cannot reach such a target without losing its clearance.
template <class T>
bool covers(const Avoidance<T>& avoidance, const Obstacle<T>& obstacle, const Position<T>& target_m,
            const T& acceptance_m) {
  return distance_m(obstacle.centre_m, target_m) + acceptance_m <=
         obstacle.radius_m + avoidance.vehicle_radius_m + avoidance.clearance_m;
}

/// True if one of `count` obstacles covers the target, as covers() above defines.
template <class T>
bool is_covered(const Avoidance<T>& avoidance, const Obstacle<T>* obstacles, int count,
                const Position<T>& target_m, const T& acceptance_m) {
  for (int i = 0; i < count; ++i) {
    if (covers(avoidance, obstacles[i], target_m, acceptance_m)) return true;
  }
  return false;
}

/// Turns the heading `guidance_rad` out of the sectors that `count` obstacles block, and reduces
/// the speed while an obstacle is close ahead. `target_m` is the distance to the guidance target,
/// beyond which obstacles are ignored; without a target it is no_target_m(). `psi_rad` and `u_mps`
/// are the vehicle's heading and surge speed. `sectors` is work space for `count` elements.
template <class T>
AWMR_CALLED Avoided<T> avoid(const Avoidance<T>& avoidance, const Obstacle<T>* obstacles,
                             Sector<T>* sectors, int count, const Position<T>& position_m,
                             const T& psi_rad, const T& u_mps, const T& guidance_rad,
                             const T& target_m, AvoidanceState& state) {
  using math::abs;
  const T mmd_m = avoidance.mmd_base_m + avoidance.mmd_per_speed_s * abs(u_mps);
  const T kept_m = state.side == AvoidanceSide::kNone ? T(0.0) : avoidance.hysteresis_m;
  const detail::Surroundings<T> around{avoidance, obstacles, sectors,        count,   position_m,
                                       psi_rad,   mmd_m,     mmd_m + kept_m, target_m};
  around.find_sectors();
  const T share = around.speed_share();
  const T left = around.turn_out(guidance_rad, T(1.0));
  if (!(left > T(0.0))) {
    state.side = AvoidanceSide::kNone;
    return {called_wrap_angle(guidance_rad), share, false, false};
  }
  const T right = around.turn_out(guidance_rad, T(-1.0));
  const T full = T(2.0) * pi<T>();
  if (!(left < full) && !(right < full)) {
    return {called_wrap_angle(guidance_rad), T(0.0), true, true};
  }
  // Keep the side unless the turn to the other side is smaller by more than the hysteresis. If both
  // turns are equal and no side was chosen before, turn left.
  T difference = left - right;
  if (state.side == AvoidanceSide::kLeft) difference -= avoidance.side_hysteresis_rad;
  if (state.side == AvoidanceSide::kRight) difference += avoidance.side_hysteresis_rad;
  const bool to_right = difference > T(0.0);
  state.side = to_right ? AvoidanceSide::kRight : AvoidanceSide::kLeft;
  return {called_wrap_angle(to_right ? guidance_rad - right : guidance_rad + left), share, true,
          false};
}

}  // namespace awmr
