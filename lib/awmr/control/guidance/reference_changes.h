/// Changes the reference that the guidance along the route has computed: turns its heading away
/// from obstacles and smooths it. The overloads for Disabled<Part> do nothing. Freestanding C++14.
#pragma once

#include "awmr/control/flash.h"
#include "awmr/control/guidance/parts.h"

namespace awmr {

/// Target of the guidance in one step.
template <class T>
struct GuidanceTarget {
  const Position<T>* target_m;  ///< obstacles farther away than this point are ignored; 0: no
                                ///< obstacle is ignored
  bool arrived;                 ///< the route is finished
};

/// Distance to the target, m, for avoid() if there is no target. It is larger than the distance to
/// any obstacle, so that every obstacle counts.
template <class T>
constexpr T no_target_m() {
  return T(1e30);
}

/// Turns the reference heading away from obstacles, and reduces the reference speed while an
/// obstacle is close ahead.
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

/// Smooths the reference heading by the filter of heading_shaping.h and adds its rate and
/// acceleration. The filter starts at the vehicle's heading.
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
