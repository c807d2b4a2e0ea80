/// Direction of travel for a speed sensor without a sign, such as a GPS.
///
/// The speed law needs a signed speed: with |u| as its input, it can accelerate a vehicle that
/// rolls backward (unsigned_push()). Here, a predicted speed u gives the sign. The identified model
/// (mass m', resistance g1) and the commanded force tau_speed predict this speed:
///   m' u_dot = tau_speed - g1(u)
/// Readings of the sensor correct its magnitude. The displacement along the heading verifies its
/// sign. Rules:
///   - Braking is a force against the direction of travel. It requires a known direction, because
///     in the wrong direction this force accelerates the vehicle.
///   - The predicted speed of a braking vehicle stops at 0: braking cannot become driving backward.
///   - A direction is verified only while the vehicle does not brake, after 1 m along the heading.
///   - If the direction is unknown and |u| > |u_ref|, the vehicle coasts: tau_speed is 0.
///   - At u_ref = 0, tau_speed is 0 while |u| <= kStandstill_mps.
/// So a vehicle that stops on a slope brakes in pulses. A pulse ends when the predicted speed is 0,
/// and the next pulse starts when the displacement has verified the direction again.
#pragma once

#include <stdint.h>

#include "awmr/control/displacement.h"
#include "awmr/control/feed_forward.h"
#include "awmr/control/guidance/position.h"
#include "awmr/control/measurement.h"
#include "awmr/model/gains.h"

namespace awmr {

/// Up to this magnitude of the predicted speed, m/s, the direction of travel is unknown.
constexpr float kDirected_mps = 0.1F;
/// Distance along the heading that verifies a direction, m.
constexpr float kVerified_m = 1.0F;
/// Time since the last braking, s, before a displacement can verify the direction. It exceeds the
/// latency of a GPS plus the time in which the vehicle stops.
constexpr float kSettled_s = 1.0F;

/// Data on the direction of travel that one step of the controller keeps for the next step. If all
/// members are 0, the vehicle is at rest and its direction is unknown.
template <class T>
struct DirectedSpeed {
  /// Signed speed u that the model predicts. The direction is unknown for |u| <= kDirected_mps.
  T predicted_mps;
  T tau_speed;  ///< commanded surge force since the last step, dimensionless
  /// Displacement along the heading, m, since the last braking, standstill or verification of the
  /// direction.
  T along_m;
  T settled_s;        ///< time since the last braking, s; stops counting at kSettled_s
  Position<T> fix_m;  ///< position at the last reading, valid if has_fix
  bool has_fix;       ///< at least one reading has arrived since the start
};

/// Reading of a speed sensor without a sign.
template <class T>
struct SpeedReading {
  T speed_mps;             ///< |u|, m/s, >= 0
  Position<T> position_m;  ///< measured at the same time
  T psi_rad;               ///< heading
  bool is_new;             ///< measured since the last step
};

/// Predicts the speed u from u0 over the step of `dt_s` that ends now:
///   u = u0 + dt (tau_speed - g1(u0))/m'
/// Friction and braking can bring u to 0 but do not reverse it. `surge`: surge resistance g1;
/// `mass_inverse`: 1/m'.
template <class T, class G>
void predict_speed(DirectedSpeed<T>& d, const G& surge, const T& mass_inverse,
                   const T& speed_max_mps, const T& dt_s) {
  const T before = d.predicted_mps;
  const T step = dt_s * mass_inverse;
  const T pushed = before + step * d.tau_speed;
  T size = math::abs(pushed);
  if (size > speed_max_mps) size = speed_max_mps;
  size -= step * surge(size);
  if (!(size > T(0.0)) || math::is_opposite(pushed, before)) size = T(0.0);
  d.predicted_mps = math::with_sign(size, pushed);
  if (d.settled_s < T(kSettled_s)) d.settled_s += dt_s;
  if (math::is_opposite(d.tau_speed, before)) {
    d.settled_s = T(0.0);
    d.along_m = T(0.0);
  }
}

/// Corrects the predicted speed by a reading of the sensor, if the reading is new. When the
/// displacement verifies the direction, the predicted speed becomes the measured speed with the
/// sign of the displacement.
template <class T>
void correct_speed(DirectedSpeed<T>& d, const SpeedReading<T>& reading) {
  if (!reading.is_new) return;
  const T speed = math::abs(reading.speed_mps);
  if (d.has_fix && speed > T(kStandstill_mps)) {
    d.along_m += displacement_ahead_m(T(reading.position_m.x_m - d.fix_m.x_m),
                                      T(reading.position_m.y_m - d.fix_m.y_m), reading.psi_rad);
  } else {
    d.along_m = T(0.0);
  }
  d.fix_m = reading.position_m;
  d.has_fix = true;
  if (!(d.settled_s < T(kSettled_s)) && math::abs(d.along_m) > T(kVerified_m)) {
    d.predicted_mps = math::with_sign(speed, d.along_m);
    d.along_m = T(0.0);
    return;
  }
  T size = math::abs(d.predicted_mps);
  // While a force drives the vehicle, the predicted speed becomes the mean of prediction and
  // reading. While the vehicle coasts or brakes, only a reading below the prediction is used: a
  // larger reading can belong to motion in the other direction.
  if (d.predicted_mps * d.tau_speed > T(0.0)) {
    size = T(0.5) * (size + speed);
  } else if (size > speed) {
    size = speed;
  }
  d.predicted_mps = math::with_sign(size, d.predicted_mps);
}

/// Replaces the unsigned speed |u| in `m` by the signed speed. Where the rules at the top of this
/// file forbid a force, sets the measured speed and the reference speed to 0, so that the vehicle
/// coasts.
template <class T>
void apply_direction(const DirectedSpeed<T>& d, Measurement<T>& m, Reference<T>& ref) {
  const T speed = math::abs(m.u_mps);
  const T wanted = math::abs(ref.speed_mps);
  const bool is_known = math::abs(d.predicted_mps) > T(kDirected_mps);
  const bool is_stop = !(wanted > T(0.0));
  const bool coasts =
      is_stop ? !is_known || !(speed > T(kStandstill_mps)) : !is_known && speed > wanted;
  if (coasts) {
    m.u_mps = T(0.0);
    ref.speed_mps = T(0.0);
    ref.accel_mps2 = T(0.0);
    return;
  }
  m.u_mps = math::with_sign(speed, is_known ? d.predicted_mps : ref.speed_mps);
}

/// Force, divided by F_max, by which the speed law would accelerate a vehicle that rolls backward
/// at the speed u = speed_mps > 0, if the law received |u|. If the force exceeds the resistance
/// g1(u), the vehicle runs away. At the reference speed 0, without limits of the motors, the law
/// commands
///   tau_speed = -(m' mu_s sat(u/eps_s) + f)
/// m' is `mass_norm`; mu_s, eps_s are `gains`; f is the Coulomb friction that the law feeds
/// forward. If the surge resistance g1 = `surge` jumps at rest, f = g1(w0) sat(u/w0) with w0 =
/// feed_forward_rest_speed(); otherwise f = 0.
template <class T>
T unsigned_push(const Resistance<T>& surge, const T& mass_norm, const SpeedGains<T>& gains,
                const T& speed_mps) {
  const T correction = math::saturate(T(gains.mu / gains.epsilon * speed_mps), gains.mu);
  return mass_norm * correction - fed_forward(feed_forward(surge), T(0.0), T(-speed_mps));
}

}  // namespace awmr
