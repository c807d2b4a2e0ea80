/// Disturbance observer for surge and yaw. The control laws omit the unknown disturbance. The
/// observer estimates it, and the estimate is subtracted from the outputs of the laws. Freestanding
/// C++14.
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// Settings of an observer.
///
/// The model from which the laws are derived has an unknown disturbance d:
///   J w_dot = tau - g(w) + d                                                    [paper (80), (96)]
/// Yaw: J = I'z, w = r, d in m. Surge: J = m', w = u, d dimensionless, and m' r v added to tau. The
/// laws omit d; inside the boundary layer this causes a steady heading error of d/(J lambda
/// mu/eps). The observer
///   d_hat = z + L J w
///   z_dot = -L (tau - g(w) + d_hat)
/// has d_hat_dot = L (d - d_hat): a first-order low pass of bandwidth L without differentiation.
template <class T>
struct DisturbanceObserver {
  T bandwidth_radps;  ///< L, rad/s, > 0, L T_s < 1. Larger: follows d faster, passes more noise
  T limit;            ///< > 0, in the unit of tau: |d_hat| <= limit
};

/// State of an observer between samples.
template <class T>
struct ObserverState {
  T z;  ///< z, in the unit of tau
};

/// The state for which d_hat = 0. `momentum` is J w.
template <class T>
ObserverState<T> start_observer(const DisturbanceObserver<T>& observer, const T& momentum) {
  return {-observer.bandwidth_radps * momentum};
}

/// The estimated disturbance d_hat, in the unit of tau. If it exceeds the limit, the state z is set
/// to the value for which d_hat equals the limit. So d_hat decreases as soon as d does.
template <class T>
T estimate(const DisturbanceObserver<T>& observer, const T& momentum, ObserverState<T>& state) {
  const T share = observer.bandwidth_radps * momentum;
  const T d = math::saturate(state.z + share, observer.limit);
  state.z = d - share;
  return d;
}

/// Advances the state by one sample. `known` is tau - g(w). If tau is the requested command and not
/// the limited one, a saturated actuator looks like a disturbance, and d_hat winds up.
template <class T>
void advance(const DisturbanceObserver<T>& observer, const T& d_hat, const T& known,
             const T& sample_time_s, ObserverState<T>& state) {
  state.z -= sample_time_s * observer.bandwidth_radps * (known + d_hat);
}

/// The observers of surge and yaw.
template <class T>
struct Observers {
  DisturbanceObserver<T> yaw;    ///< limit in m
  DisturbanceObserver<T> surge;  ///< dimensionless limit
  /// true: the observers use the limited command. false: they use the requested command and wind up
  /// at a limit, for comparison.
  bool anti_windup;
};

/// States of both observers.
template <class T>
struct ObserversState {
  ObserverState<T> yaw;
  ObserverState<T> surge;
};

/// Surge force and yaw moment, over F_max.
template <class T>
struct AxisForces {
  T surge;  ///< dimensionless, forward positive
  T yaw_m;  ///< m, counter-clockwise positive
};

/// Quantities of the motion at one sample.
template <class T>
struct ObservedMotion {
  AxisForces<T> momentum;    ///< m' u and I'z r
  AxisForces<T> resistance;  ///< g1(u) and g3(r)
  T coupling;                ///< m' r v
};

/// The states for which both d_hat are 0.
template <class T>
ObserversState<T> start_observers(const Observers<T>& observers, const AxisForces<T>& momentum) {
  return {start_observer(observers.yaw, momentum.yaw_m),
          start_observer(observers.surge, momentum.surge)};
}

/// The estimated disturbances d_hat in surge and yaw.
template <class T>
AWMR_CALLED AxisForces<T> estimate(const Observers<T>& observers, const ObservedMotion<T>& motion,
                                   ObserversState<T>& state) {
  return {estimate(observers.surge, motion.momentum.surge, state.surge),
          estimate(observers.yaw, motion.momentum.yaw_m, state.yaw)};
}

/// Advances both states by one sample. `requested`: the outputs of the laws minus d_hat.
/// `allocated`: the forces that the allocation makes of this request.
template <class T>
AWMR_CALLED void advance(const Observers<T>& observers, const AxisForces<T>& d_hat,
                         const AxisForces<T>& requested, const GeneralisedForces<T>& allocated,
                         const ObservedMotion<T>& motion, const T& sample_time_s,
                         ObserversState<T>& state) {
  AxisForces<T> tau = requested;
  if (observers.anti_windup) {
    tau = {allocated.tau_speed, allocated.tau_steering_m + allocated.tau_diff_m};
  }
  advance(observers.yaw, d_hat.yaw_m, T(tau.yaw_m - motion.resistance.yaw_m), sample_time_s,
          state.yaw);
  advance(observers.surge, d_hat.surge, T(tau.surge + motion.coupling - motion.resistance.surge),
          sample_time_s, state.surge);
}

}  // namespace awmr
