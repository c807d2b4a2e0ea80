/// What motion.h asks of a vehicle, for one on four tyres (model/tyres.h). Private to this folder.
#pragma once

#include "awmr/model/tyres.h"
#include "awmr/simulate/motion.h"

namespace awmr {

/// Rates of the state with what pushes the vehicle.
template <class T, class Forces>
State<T> pushed_rates(const FourWheels<T>& vehicle, const Push<T>& push, const State<T>& at,
                      const Forces& force, const T& steering_command_rad) {
  return with_push(state_rates(vehicle, at, force, steering_command_rad), vehicle.body, push, at);
}

/// Faster than this nothing of the vehicle changes at `at`: the turning of the velocity in its frame, the
/// tyres, and the resistance of the drives at the speed of the fastest wheel.
template <class T>
T fastest_rate(const FourWheels<T>& vehicle, const State<T>& at) {
  using math::abs;
  using math::larger;
  const Plant<T>& body = vehicle.body;
  const WheelSpeeds<T> w = wheel_speeds(body.front_axle_m, body.half_track_m, at);
  const T fastest_mps = larger(larger(T(abs(w.front_left)), T(abs(w.front_right))),
                               larger(T(abs(w.rear_left)), T(abs(w.rear_right))));
  const T rolling = decay_rate(body.surge, rolling_inertia(body), fastest_mps);
  return larger(larger(T(abs(at.r_radps)), tyre_rate(vehicle, at)), rolling);
}

}  // namespace awmr
