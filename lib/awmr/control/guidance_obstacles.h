/// Obstacle avoidance: turns a guidance heading out of the sectors that circular obstacles block.
/// Freestanding C++14.
///
/// The paper names MMD, D_obs and sigma, its figure of the algorithm is lost  [paper 5.2.2]; this
/// is this project's definition.
///
///   MMD(u)  = mmd_base + mmd_per_speed |u|              minimum manoeuvring distance
///   R_i     = radius_i + vehicle_radius + clearance     grown radius
///   D_i     = |c_i - p|,  D_obs = D_i - R_i             distance to the grown edge
///   w_i     = clamp((MMD - D_obs)/MMD, 0, 1)            how far D_obs is inside MMD
///   alpha_i = asin(R_i/D_i) + sigma w_i                 half angle of the blocked sector around
///   the
///                                                       bearing of c_i; pi/2 + sigma w_i inside
///                                                       R_i
/// An obstacle counts while D_obs <= MMD (+ hysteresis once avoidance is on) and it is nearer than
/// the target. psi_d is turned from the guidance heading to the nearest edge of the union of the
/// blocked sectors that contain it, left or right; the side once taken is kept until the other is
/// nearer by `side_hysteresis_rad`, or until the guidance heading is free again.
///
/// A vehicle of turning radius rho that heads for the middle of a circle can still pass it from
/// D^2 >= (R + rho)^2 - rho^2, that is D_obs < rho whatever R: MMD >= rho plus the way travelled
/// while the turn begins is enough for one obstacle. Where that does not hold (several obstacles, a
/// start too near) the speed is cut: along the ray of the heading, the distance to a circle grown
/// by vehicle_radius + clearance/2 over `brake_m` is the share of the speed that is allowed, so
/// that the vehicle stops before it.
///
/// Edge cases: inside R_i the sector is more than a half-plane, so psi_d leads out, and a heading
/// further in is stopped; on the very centre the bearing is the vehicle's heading; every direction
/// blocked: `blocked`, share 0, psi_d unchanged. An obstacle on a waypoint: see covers().
#pragma once

#include "awmr/control/controller.h"
#include "awmr/control/guidance.h"

namespace awmr {

template <class T>
struct Obstacle {
  Position<T> centre_m;
  T radius_m;  ///< > 0
};

template <class T>
struct Avoidance {
  T mmd_base_m;           ///< > 0
  T mmd_per_speed_s;      ///< >= 0
  T sigma_rad;            ///< in [0, pi/2): how much further than the tangent it turns at D_obs = 0
  T vehicle_radius_m;     ///< >= 0: of the circle around the vehicle
  T clearance_m;          ///< > 0: to keep free beside it
  T hysteresis_m;         ///< >= 0
  T side_hysteresis_rad;  ///< >= 0
  T brake_m;              ///< > 0
};

enum class AvoidanceSide { kNone, kLeft, kRight };

struct AvoidanceState {
  AvoidanceSide side = AvoidanceSide::kNone;  ///< kNone: the guidance heading is free
};

template <class T>
struct Avoided {
  T psi_rad;      ///< psi_d, in (-pi, pi]
  T speed_share;  ///< of u_d, in [0, 1]
  bool active;    ///< psi_d is not the guidance heading
  bool blocked;   ///< every direction is
};

/// True where the obstacle's grown circle holds the whole acceptance circle of a target: no course
/// that keeps the clearance reaches it.
template <class T>
bool covers(const Avoidance<T>& avoidance, const Obstacle<T>& obstacle, const Position<T>& target_m,
            const T& acceptance_m) {
  return distance_m(obstacle.centre_m, target_m) + acceptance_m <=
         obstacle.radius_m + avoidance.vehicle_radius_m + avoidance.clearance_m;
}

namespace detail {

/// Sectors whose edge is nearer than this are left: rad, above the rounding of a float.
template <class T>
constexpr T sector_tolerance_rad() {
  return T(1e-4);
}

template <class T>
struct Sector {
  T bearing_rad;
  T half_rad;
  bool counts;
};

/// asin(s) for s in [0, 1).
template <class T>
T arc_sine(const T& s) {
  using math::atan2;
  using math::sqrt;
  return atan2(s, sqrt(T(1.0) - s * s));
}

/// What the vehicle is asked to avoid, at one step.
template <class T>
struct Surroundings {
  const Avoidance<T>& avoidance;
  const Obstacle<T>* obstacles;
  int count;
  Position<T> position_m;
  T psi_rad;
  T mmd_m;
  T reach_m;
  T target_m;

  Sector<T> sector(int i) const {
    const Obstacle<T>& obstacle = obstacles[i];
    const T grown_m = obstacle.radius_m + avoidance.vehicle_radius_m + avoidance.clearance_m;
    const T centre_m = distance_m(position_m, obstacle.centre_m);
    const T free_m = centre_m - grown_m;
    const bool counts = !(free_m > reach_m) && free_m < target_m;
    if (!counts) return {T(0.0), T(0.0), false};
    const T inside = math::clamp((mmd_m - free_m) / mmd_m, T(0.0), T(1.0));
    const T tangent = free_m > T(0.0) ? arc_sine(grown_m / centre_m) : pi<T>() / T(2.0);
    return {direction_rad(position_m, obstacle.centre_m, psi_rad),
            tangent + avoidance.sigma_rad * inside, true};
  }

  /// How far `heading_rad` has to turn to `sign` (1: left, -1: right) to leave all sectors; 2 pi or
  /// more: it cannot.
  T turn_out(const T& heading_rad, const T& sign) const {
    const T full = T(2.0) * pi<T>();
    T turned = T(0.0);
    for (int pass = 0; pass < count; ++pass) {
      bool moved = false;
      for (int i = 0; i < count && turned < full; ++i) {
        const Sector<T> s = sector(i);
        if (!s.counts) continue;
        const T off = wrap_angle(s.bearing_rad - heading_rad - sign * turned);
        const T magnitude = off < T(0.0) ? -off : off;
        if (!(magnitude < s.half_rad - sector_tolerance_rad<T>())) continue;
        turned += sign * off + s.half_rad;
        moved = true;
      }
      if (!moved || !(turned < full)) break;
    }
    return turned;
  }

  /// The share of the speed at which the vehicle may go on along its heading.
  T speed_share() const {
    using math::abs;
    using math::cos;
    using math::sin;
    using math::sqrt;
    T share = T(1.0);
    for (int i = 0; i < count; ++i) {
      const T grown_m =
          obstacles[i].radius_m + avoidance.vehicle_radius_m + avoidance.clearance_m / T(2.0);
      const T centre_m = distance_m(position_m, obstacles[i].centre_m);
      const T off = direction_rad(position_m, obstacles[i].centre_m, psi_rad) - psi_rad;
      const T along_m = centre_m * cos(off);
      const T beside_m = centre_m * sin(off);
      if (!(along_m > T(0.0)) || !(beside_m * beside_m < grown_m * grown_m)) continue;
      const T free_m = along_m - sqrt(grown_m * grown_m - beside_m * beside_m);
      const T allowed = math::clamp(free_m / avoidance.brake_m, T(0.0), T(1.0));
      if (allowed < share) share = allowed;
    }
    return share;
  }
};

}  // namespace detail

/// `guidance_rad` is the heading that the guidance wants, `target_m` the distance to where it leads
/// (obstacles beyond it do not matter; a very large number where there is no target).
template <class T>
Avoided<T> avoid(const Avoidance<T>& avoidance, const Obstacle<T>* obstacles, int count,
                 const Position<T>& position_m, const T& psi_rad, const T& u_mps,
                 const T& guidance_rad, const T& target_m, AvoidanceState& state) {
  using math::abs;
  const T mmd_m = avoidance.mmd_base_m + avoidance.mmd_per_speed_s * abs(u_mps);
  const T kept_m = state.side == AvoidanceSide::kNone ? T(0.0) : avoidance.hysteresis_m;
  const detail::Surroundings<T> around{avoidance, obstacles, count,          position_m,
                                       psi_rad,   mmd_m,     mmd_m + kept_m, target_m};
  const T share = around.speed_share();
  const T left = around.turn_out(guidance_rad, T(1.0));
  if (!(left > T(0.0))) {
    state.side = AvoidanceSide::kNone;
    return {wrap_angle(guidance_rad), share, false, false};
  }
  const T right = around.turn_out(guidance_rad, T(-1.0));
  const T full = T(2.0) * pi<T>();
  if (!(left < full) && !(right < full)) {
    return {wrap_angle(guidance_rad), T(0.0), true, true};
  }
  // Keeping the side taken is worth the hysteresis; of two equal sides the left is taken.
  T difference = left - right;
  if (state.side == AvoidanceSide::kLeft) difference -= avoidance.side_hysteresis_rad;
  if (state.side == AvoidanceSide::kRight) difference += avoidance.side_hysteresis_rad;
  const bool to_right = difference > T(0.0);
  state.side = to_right ? AvoidanceSide::kRight : AvoidanceSide::kLeft;
  return {wrap_angle(to_right ? guidance_rad - right : guidance_rad + left), share, true, false};
}

}  // namespace awmr
