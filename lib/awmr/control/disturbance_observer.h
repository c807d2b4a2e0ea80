/// Estimates the disturbance that the printed laws leave out, so that it can be taken off the
/// command. Freestanding C++14.
///
/// The laws of [paper (80), (96)] carry a disturbance that nobody knows and that drops out of (89)
/// and (102); inside the boundary layer it leaves a steady error d/(J mu/eps lambda). With
///   J w_dot = tau - g(w) + d
/// (yaw: J = I'z, w = r; surge: J = m', w = u, and m' r v added to tau) the observer
///   d_hat = z + L J w,   z_dot = -L (tau - g(w) + d_hat)
/// has d_hat_dot = L (d - d_hat): a first-order low pass of bandwidth L without differentiation.
#pragma once

#include "awmr/model/scalar_math.h"

namespace awmr {

template <class T>
struct DisturbanceObserver {
  T bandwidth_radps;  ///< L > 0; L T_s < 1
  T limit;            ///< > 0, in the unit of tau: |d_hat| stays within it
};

template <class T>
struct ObserverState {
  T z;
};

/// At d_hat = 0. `momentum` is J w.
template <class T>
ObserverState<T> start_observer(const DisturbanceObserver<T>& observer, const T& momentum) {
  return {-observer.bandwidth_radps * momentum};
}

/// d_hat. At the limit the state is set back to it, so that it leaves at once when d falls.
template <class T>
T estimate(const DisturbanceObserver<T>& observer, const T& momentum, ObserverState<T>& state) {
  const T share = observer.bandwidth_radps * momentum;
  const T d = math::saturate(state.z + share, observer.limit);
  state.z = d - share;
  return d;
}

/// One sample on; `known` is tau - g(w), with the tau that the limits have left (anti-windup: with
/// the tau that was asked for, a saturated actuator would look like a disturbance).
template <class T>
void advance(const DisturbanceObserver<T>& observer, const T& d_hat, const T& known,
             const T& sample_time_s, ObserverState<T>& state) {
  state.z -= sample_time_s * observer.bandwidth_radps * (known + d_hat);
}

}  // namespace awmr
