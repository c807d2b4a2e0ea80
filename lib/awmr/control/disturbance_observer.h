/// Estimates the disturbance that the printed laws leave out, so that it can be taken off the
/// command. Freestanding C++14.
#pragma once

#include "awmr/model/scalar_math.h"

namespace awmr {

/// How an observer is set.
///
/// The model that the laws are derived from carries a disturbance d that nobody knows:
///   J w_dot = tau - g(w) + d                                                    [paper (80), (96)]
/// Yaw: J = I'z, w = r, d in m. Surge: J = m', w = u, d dimensionless, and m' r v added to tau. The
/// laws leave d out; inside the boundary layer it then costs a steady heading error of
/// d/(J lambda mu/eps). The observer
///   d_hat = z + L J w
///   z_dot = -L (tau - g(w) + d_hat)
/// has d_hat_dot = L (d - d_hat): a first-order low pass of bandwidth L without differentiation.
template <class T>
struct DisturbanceObserver {
  T bandwidth_radps;  ///< L, rad/s, > 0, L T_s < 1. Larger: follows d faster and lets more noise in
  T limit;            ///< > 0, in the unit of tau: |d_hat| <= limit
};

/// What an observer remembers from sample to sample.
template <class T>
struct ObserverState {
  T z;  ///< z, in the unit of tau
};

/// The state in which d_hat = 0. `momentum` is J w.
template <class T>
ObserverState<T> start_observer(const DisturbanceObserver<T>& observer, const T& momentum) {
  return {-observer.bandwidth_radps * momentum};
}

/// d_hat, in the unit of tau. At the limit the state is set back, so that d_hat leaves the limit at
/// once when d falls.
template <class T>
T estimate(const DisturbanceObserver<T>& observer, const T& momentum, ObserverState<T>& state) {
  const T share = observer.bandwidth_radps * momentum;
  const T d = math::saturate(state.z + share, observer.limit);
  state.z = d - share;
  return d;
}

/// Moves the state on by one sample. `known` is tau - g(w), with the tau that the limits have left:
/// with the tau that was asked for, a saturated actuator would look like a disturbance and d_hat
/// would wind up.
template <class T>
void advance(const DisturbanceObserver<T>& observer, const T& d_hat, const T& known,
             const T& sample_time_s, ObserverState<T>& state) {
  state.z -= sample_time_s * observer.bandwidth_radps * (known + d_hat);
}

}  // namespace awmr
