/// Geometry of the obstacle avoidance: the headings that circular obstacles block, and the speed
/// that the obstacles permit. obstacles.h explains the symbols.
#pragma once

#include "awmr/control/guidance/position.h"
#include "awmr/control/wrap_angle.h"

namespace awmr {

/// A disc that the vehicle must not touch.
template <class T>
struct Obstacle {
  Position<T> centre_m;  ///< c_i, m, in the world frame
  T radius_m;            ///< radius_i, m, > 0
};

/// Parameters of the avoidance, with the symbols of obstacles.h.
template <class T>
struct Avoidance {
  /// mmd_base, m, > 0: minimum manoeuvring distance MMD at speed 0. The avoidance begins at the
  /// distance MMD from an obstacle. mmd_base must be at least the vehicle's turning radius.
  T mmd_base_m;
  /// mmd_per_speed, s, >= 0: MMD grows by this per m/s of speed. A suitable value is the delay
  /// before a turn takes effect (servo, yaw inertia).
  T mmd_per_speed_s;
  /// sigma, rad, in [0, pi/2): angle by which the blocked sector exceeds the tangent to the
  /// obstacle, for a vehicle at the obstacle's edge. A larger angle makes the vehicle pass at a
  /// larger distance.
  T sigma_rad;
  /// vehicle_radius, m, >= 0: radius of the circle around the centre of gravity that encloses the
  /// vehicle.
  T vehicle_radius_m;
  /// clearance, m, > 0: free distance between that circle and the obstacle.
  T clearance_m;
  /// Hysteresis of the distance, m, >= 0. While obstacles are avoided, an obstacle counts until its
  /// distance D_obs exceeds MMD by this value. If this value were 0, the avoidance could switch on
  /// and off again and again at D_obs = MMD.
  T hysteresis_m;
  /// Hysteresis of the side, rad, >= 0. The vehicle changes the side on which it passes only if the
  /// turn to the other side is smaller by more than this. If this were 0, it could swerve left and
  /// right.
  T side_hysteresis_rad;
  /// brake, m, > 0: free distance ahead below which the avoidance reduces the speed. It must be at
  /// least the stopping distance.
  T brake_m;
};

/// Range of headings that one obstacle blocks.
template <class T>
struct Sector {
  T bearing_rad;  ///< bearing of the obstacle's centre, in the world frame
  T half_rad;     ///< alpha_i, rad: half angle of the sector
  bool counts;    ///< false: the obstacle is too far away, or beyond the target, and blocks nothing
};

namespace detail {

/// Bearing of a point from the vehicle, rad, in the world frame. If both coincide: `otherwise_rad`.
template <class T>
AWMR_CALLED T bearing_rad(const Position<T>& from, const Position<T>& point,
                          const T& otherwise_rad) {
  return direction_rad(seen_from(from, point), otherwise_rad);
}

/// A heading that is inside a blocked sector by less than this, rad, counts as outside. The angle
/// exceeds the rounding error of a float: otherwise, a heading on the edge of a sector could count
/// as blocked.
template <class T>
constexpr T sector_tolerance_rad() {
  return T(1e-4);
}

/// asin(s) for s in [0, 1).
template <class T>
T arc_sine(const T& s) {
  using math::atan2;
  using math::sqrt;
  return atan2(s, sqrt(T(1.0) - s * s));
}

/// Obstacles and vehicle state in one step.
template <class T>
struct Surroundings {
  const Avoidance<T>& avoidance;
  const Obstacle<T>* obstacles;  ///< `count` of them
  Sector<T>* sectors;            ///< one for each obstacle
  int count;
  Position<T> position_m;  ///< p: position of the vehicle
  T psi_rad;               ///< the vehicle's heading
  T mmd_m;                 ///< MMD(u): minimum manoeuvring distance
  /// Largest distance D_obs at which an obstacle counts, m: MMD, plus the hysteresis while
  /// obstacles are avoided.
  T reach_m;
  T target_m;  ///< distance to the guidance target

  /// The sector that obstacle i blocks.
  AWMR_CALLED Sector<T> sector(int i) const {
    const Obstacle<T>& obstacle = obstacles[i];
    const T grown_m = obstacle.radius_m + avoidance.vehicle_radius_m + avoidance.clearance_m;
    const T centre_m = distance_m(position_m, obstacle.centre_m);
    const T free_m = centre_m - grown_m;
    const bool counts = !(free_m > reach_m) && free_m < target_m;
    if (!counts) return {T(0.0), T(0.0), false};
    const T inside = math::clamp((mmd_m - free_m) / mmd_m, T(0.0), T(1.0));
    const T tangent = free_m > T(0.0) ? arc_sine(T(grown_m / centre_m)) : pi<T>() / T(2.0);
    return {bearing_rad(position_m, obstacle.centre_m, psi_rad),
            tangent + avoidance.sigma_rad * inside, true};
  }

  void find_sectors() const {
    for (int i = 0; i < count; ++i) sectors[i] = sector(i);
  }

  /// Angle by which `heading_rad` must turn to leave all blocked sectors, rad, >= 0: to the left
  /// for sign = 1, to the right for sign = -1. 2 pi or more: every direction is blocked.
  AWMR_CALLED T turn_out(const T& heading_rad, const T& sign) const {
    const T full = T(2.0) * pi<T>();
    T turned = T(0.0);
    for (int pass = 0; pass < count; ++pass) {
      bool moved = false;
      for (int i = 0; i < count && turned < full; ++i) {
        const Sector<T>& s = sectors[i];
        if (!s.counts) continue;
        const T off = called_wrap_angle(s.bearing_rad - heading_rad - sign * turned);
        const T magnitude = off < T(0.0) ? -off : off;
        if (!(magnitude < s.half_rad - sector_tolerance_rad<T>())) continue;
        turned += sign * off + s.half_rad;
        moved = true;
      }
      if (!moved || !(turned < full)) break;
    }
    return turned;
  }

  /// Fraction of the reference speed u_d that obstacles ahead of the vehicle permit, in [0, 1].
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
      // Skip circles that are farther away than brake_m, because they do not limit the speed.
      if (centre_m - grown_m > avoidance.brake_m) continue;
      const T off = bearing_rad(position_m, obstacles[i].centre_m, psi_rad) - psi_rad;
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

}  // namespace awmr
