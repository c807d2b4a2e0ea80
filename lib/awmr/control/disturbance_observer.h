/// Disturbance observer for surge and yaw: estimates external forces that the control laws do not
/// know, such as a slope. The estimate is subtracted from the outputs of the laws.
#pragma once

#include "awmr/model/dynamics.h"
#include "awmr/model/scalar_math.h"

namespace awmr {

/// Settings of an observer.
///
/// The model from which the laws are derived has an unknown disturbance d:
///   J w_dot = tau - g(w) + d                                                    [paper (80), (96)]
/// J: inertia, w: speed, tau: commanded force or moment, g: resistance; all forces, moments and
/// inertias are divided by F_max. Yaw: J = I'z, w = r, d in m. Surge: J = m', w = u, d
/// dimensionless, and m' r v is added to tau. The heading law and the speed law omit d. Inside the
/// boundary layer of the heading law (gains lambda, mu, eps), this causes a steady heading error of
/// d/(J lambda mu/eps). The observer with the state z and the bandwidth L
///   d_hat = z + L J w
///   z_dot = -L (tau - g(w) + d_hat)
/// has d_hat_dot = L (d - d_hat): a first-order low pass of d that needs no differentiation.
template <class T>
struct DisturbanceObserver {
  /// Bandwidth L, rad/s, > 0, with L T_s < 1 for the sample time T_s. The larger L, the faster the
  /// estimate follows the disturbance, and the more measurement noise it contains.
  T bandwidth_radps;
  T limit;  ///< limit of |d_hat|, > 0, in the unit of tau
};

/// State of an observer between samples.
template <class T>
struct ObserverState {
  T z;  ///< z, in the unit of tau
};

/// Returns the initial state z, for which the estimate d_hat is 0. `momentum` is J w.
template <class T>
ObserverState<T> start_observer(const DisturbanceObserver<T>& observer, const T& momentum) {
  return {-observer.bandwidth_radps * momentum};
}

/// Returns the estimated disturbance d_hat, in the unit of tau. If d_hat exceeds the limit, sets
/// the state z to the value for which d_hat equals the limit. So d_hat decreases at once when the
/// disturbance decreases.
template <class T>
T estimate(const DisturbanceObserver<T>& observer, const T& momentum, ObserverState<T>& state) {
  const T share = observer.bandwidth_radps * momentum;
  const T d = math::saturate(state.z + share, observer.limit);
  state.z = d - share;
  return d;
}

/// Advances the state by one sample. `known` is the known force tau - g(w). Its tau must be the
/// limited command. If the observer used the requested command, an actuator at its limit would look
/// like a disturbance, and the estimate d_hat would wind up (keep growing).
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
  /// True: the observers use the limited command. False, only for comparison: they use the
  /// requested command, so the estimate winds up while an actuator is at its limit.
  bool anti_windup;
};

/// States of both observers.
template <class T>
struct ObserversState {
  ObserverState<T> yaw;
  ObserverState<T> surge;
};

/// Surge force and yaw moment, each divided by F_max.
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

/// Returns the initial states, for which the estimates d_hat of both observers are 0.
template <class T>
ObserversState<T> start_observers(const Observers<T>& observers, const AxisForces<T>& momentum) {
  return {start_observer(observers.yaw, momentum.yaw_m),
          start_observer(observers.surge, momentum.surge)};
}

/// Returns the estimated disturbances d_hat in surge and yaw.
template <class T>
AWMR_CALLED AxisForces<T> estimate(const Observers<T>& observers, const ObservedMotion<T>& motion,
                                   ObserversState<T>& state) {
  return {estimate(observers.surge, motion.momentum.surge, state.surge),
          estimate(observers.yaw, motion.momentum.yaw_m, state.yaw)};
}

/// Advances both observers by one sample. `requested`: outputs of the laws minus d_hat.
/// `allocated`: forces that the allocated commands make.
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
