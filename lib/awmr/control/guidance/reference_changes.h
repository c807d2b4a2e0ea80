/// Changes of the reference that the guidance has computed: turns the heading away from obstacles,
/// and smooths it. The overloads for Disabled<Part>, a part that is not compiled in, do nothing.
#pragma once

#include "awmr/control/flash.h"
#include "awmr/control/guidance/parts.h"

namespace awmr {

/// Target of the guidance in one step.
template <class T>
struct GuidanceTarget {
  /// Target point of the guidance; obstacles farther away than this point are ignored. Null: no
  /// obstacle is ignored.
  const Position<T>* target_m;
  bool arrived;  ///< the route is finished
};

/// Distance to the target, m, that avoid() gets if the guidance has no target. It exceeds the
/// distance of every obstacle, so that all obstacles count.
template <class T>
constexpr T no_target_m() {
  return T(1e30);
}

/// Turns the reference heading away from obstacles, and reduces the reference speed if an obstacle
/// is close ahead.
template <class Part, class T, class Time>
AWMR_INLINE void steer_around_obstacles(Disabled<Part>&, const VehiclePose<T, Time>&,
                                        const GuidanceTarget<T>&, Reference<T>&) {}
template <class T, class Time>
AWMR_CALLED void steer_around_obstacles(Avoider<T>& part, const VehiclePose<T, Time>& at,
                                        const GuidanceTarget<T>& target, Reference<T>& ref) {
  if (part.count <= 0) return;
  const T target_m =
      target.target_m != 0 ? distance_m(at.position_m, *target.target_m) : no_target_m<T>();
  const Avoided<T> avoided =
      avoid(part.avoidance, part.obstacles, part.sectors, part.count, at.position_m,
            at.measured.psi_rad, at.measured.u_mps, ref.psi_rad, target_m, part.state);
  ref.speed_mps *= avoided.speed_share;
  if (!avoided.active) return;
  ref.psi_rad = avoided.psi_rad;
  ref.psi_rate_radps = T(0.0);
}

/// Smooths the reference heading by the filter of heading_shaping.h, and sets the heading rate and
/// acceleration of the reference. The filter starts at the vehicle's heading.
template <class Part, class T, class Time>
AWMR_INLINE void shape_heading(Disabled<Part>&, const VehiclePose<T, Time>&, Reference<T>&) {}
template <class T, class Time>
AWMR_CALLED void shape_heading(Shaper<T>& part, const VehiclePose<T, Time>& at, Reference<T>& ref) {
  if (!part.is_on) return;
  if (!part.is_started) part.state = start_shaping(at.measured.psi_rad);
  part.is_started = true;
  shape(part.filter, ref.psi_rad, part.sample_time_s, part.state);
  ref.psi_rad = part.state.psi_rad;
  ref.psi_rate_radps = part.state.psi_rate_radps;
  ref.psi_accel_radps2 = part.state.psi_accel_radps2;
}

}  // namespace awmr
