/// Controller gains and their time constants. Freestanding C++14.
#pragma once

#include "awmr/model/resistance.h"

namespace awmr {

/// Gains of the heading law, heading_law() in control/heading_law.h. The law drives the sliding
/// variable S = e_dot + lambda e to 0, where e = psi_d - psi is the heading error (psi_d: desired
/// heading).
template <class T>
struct HeadingGains {
  /// lambda, 1/s, > 0: slope of the sliding surface S = 0. The larger lambda, the faster the
  /// heading error falls.
  T lambda;
  /// mu, rad/s^2, > 0: largest corrective yaw acceleration. It must exceed the yaw acceleration of
  /// a disturbance, |d|/I'z (d: disturbing yaw moment, I'z: yaw inertia, both divided by F_max);
  /// with a smaller mu, the disturbance drives S out of the boundary layer.
  T mu;
  /// epsilon, rad/s, > 0: half width of the boundary layer |S| <= epsilon, in which the correction
  /// is proportional to S. The larger epsilon, the less the commands chatter, and the slower the
  /// heading responds to small errors.
  T epsilon;
  /// w0, rad/s, >= 0.02: friction width in steering mode. Below this yaw rate, the controller feeds
  /// forward the yaw resistance as a smooth curve, because g3 itself jumps at rest
  /// (Gains::friction_width_at()). No effect without Coulomb friction in yaw.
  T friction_width_radps = feed_forward_rest_speed<T>();
  /// Friction width in combined mode, rad/s, >= 0.02, or 0 for its default: the larger of w0/2 and
  /// 0.02. No effect with an observer, which uses w0 in every mode.
  T combined_friction_width_radps = T(0.0);

  /// Time constant T1 of sliding, s: on the surface S = 0, the heading error falls as exp(-t/T1).
  ///   T1 = 1/lambda                                                              [paper (90)-(91)]
  T sliding_time_constant_s() const { return T(1.0) / lambda; }

  /// Time constant T2 of reaching the surface S = 0, s: in the boundary layer |S| <= epsilon, V =
  /// S^2/2 falls as exp(-t/T2), so S falls as exp(-t/(2 T2)).
  ///   T2 = epsilon/(2 mu)                                             [paper (92)-(95), corrected]
  /// Corrected: the paper calls this phase sliding, although the surface is only being reached.
  T reaching_time_constant_s() const { return epsilon / (T(2.0) * mu); }
};

/// Gains of the speed law, speed_law() in control/speed_law.h, on the speed error e_u = u_d - u.
/// The paper prints no values for them.
template <class T>
struct SpeedGains {
  T mu;       ///< mu_s, m/s^2, > 0: largest corrective acceleration
  T epsilon;  ///< eps_s, m/s, > 0: for |e_u| <= eps_s, the correction is proportional to e_u
};

/// Disturbance observer of the heading and the speed law (control/disturbance_observer.h), if one
/// was tuned with the gains.
template <class T>
struct ObserverGains {
  /// L, rad/s, >= 0: bandwidth; 0: no observer. L T_s < 1 with the controller's sample time T_s.
  /// The larger L, the sooner disturbances are compensated, and the more measurement noise reaches
  /// the commands.
  T bandwidth_radps = T(0.0);
  T yaw_max_m = T(0.0);  ///< m, > 0: largest moment divided by F_max that is compensated
  T surge_max = T(0.0);  ///< dimensionless, > 0: largest force divided by F_max that is compensated

  bool is_on() const { return bandwidth_radps > T(0.0); }
};

/// The gains of both loops.
template <class T>
struct Gains {
  HeadingGains<T> heading;
  SpeedGains<T> speed;
  ObserverGains<T> observer = {};

  /// Friction width w, rad/s, in a mode of yaw control. At yaw rates below w, the controller feeds
  /// forward the resistance g3(w) sat((psi_d_dot + lambda e)/w) instead of g3, which jumps at rest
  /// (fed_forward()). The larger w, the less noise the steering command has, and the larger is the
  /// heading error at rest, which only an observer removes. If the gains have an observer, w is w0
  /// in every mode. If they have none, w depends on the share s = `steering_share` of the yaw
  /// moment that the steering makes: 0.02 for s = 0, the width of the combined mode for s = 1/2, w0
  /// for s = 1.
  T friction_width_at(const T& steering_share) const {
    const T w0 = heading.friction_width_radps;
    if (observer.is_on() || steering_share > T(0.5)) return w0;
    const T combined = heading.combined_friction_width_radps;
    if (steering_share > T(0.0) && combined > T(0.0)) return combined;
    return math::larger(feed_forward_rest_speed<T>(), T(steering_share * w0));
  }
};

}  // namespace awmr
