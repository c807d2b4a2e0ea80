/// Compensates the estimated disturbance in the outputs of the control laws, and allocates the
/// result.
#pragma once

#include "awmr/control/allocation.h"
#include "awmr/control/controller.h"
#include "awmr/control/disturbance_observer.h"
#include "awmr/control/heading_law.h"
#include "awmr/control/measurement.h"
#include "awmr/control/speed_law.h"
#include "awmr/model/dynamics.h"

namespace awmr {

/// Input of the allocation (request and limits), and its output: the command.
template <class T>
struct AllocationRequest {
  const SteeringGeometry& geometry;
  const YawSplit<T>& split;
  const AllocationConstants<T>& limits;
  /// requested surge force, dimensionless, forward positive, before any limit
  T& tau_speed;
  /// requested yaw moment divided by F_max, m, counter-clockwise positive, before any limit
  T& tau_turn_m;
  Allocation<T>& command;
};

/// Computes momentum, resistance and the coupling force m' r v (m': mass divided by F_max) of the
/// measured motion from the controller's model. The disturbance observers need them.
template <class T, class G>
ObservedMotion<T> observed_motion(const PreparedController<T, G>& c, const Measurement<T>& m) {
  const ControlConstants<T>& k = c.constants;
  return {{k.mass_norm * m.u_mps, k.inertia_norm * m.r_radps},
          {c.surge(m.u_mps), c.yaw(m.r_radps)},
          k.mass_norm * m.r_radps * m.v_mps};
}

/// Surge force and yaw moment that the allocated wheel forces and steering angle make, equation
/// (41). `c`: constants of the vehicle.
template <class T>
GeneralisedForces<T> allocated_forces(const SteeringGeometry& geometry,
                                      const AllocationConstants<T>& c, const Allocation<T>& a) {
  return geometry.is_rear_driven
             ? generalised_forces(c.front_axle_m, c.half_track_m, a.force, a.steering_rad)
             : front_wheel_forces(c.front_axle_m, c.half_track_m, a.force, a.steering_rad);
}

/// Subtracts the estimated disturbance from the requested force and moment, allocates the result,
/// and passes the limited command to the observers. Null `observers`: no disturbance is subtracted.
template <class T, class G>
AWMR_INLINE void allocate_compensated(const Observers<T>* observers,
                                      const PreparedController<T, G>& c, const Measurement<T>& m,
                                      const T& sample_time_s, const AllocationRequest<T>& request,
                                      ObserversState<T>* state) {
  ObservedMotion<T> motion;
  AxisForces<T> disturbance;
  if (observers) {
    motion = observed_motion(c, m);
    disturbance = estimate(*observers, motion, *state);
    request.tau_turn_m -= disturbance.yaw_m;
    request.tau_speed -= disturbance.surge;
  }
  allocate(request.geometry, request.split, request.tau_speed, request.tau_turn_m, request.limits,
           request.command);
  if (observers) {
    advance(*observers, disturbance, {request.tau_speed, request.tau_turn_m},
            allocated_forces(request.geometry, request.limits, request.command), motion,
            sample_time_s, *state);
  }
}

}  // namespace awmr
