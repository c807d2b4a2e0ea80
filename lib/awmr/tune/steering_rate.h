/// Rate of the steering command due to sensor noise, and the friction width by which `tune` limits
/// this rate. A friction width is the yaw rate below which the heading law feeds Coulomb friction
/// forward smoothly. Private to tune/.
#pragma once

#include "awmr/tune/constraints.h"

namespace awmr {

/// RMS rate of the steering command, deg/s, that sensor noise causes while a heading is held; the
/// largest value over the modes. The motion of the vehicle that the noise causes is neglected. From
/// the yaw-rate noise n and the heading noise n_psi, the heading law computes the yaw acceleration
///   w = G(n, n_psi)/I'z - (lambda + k + L) n - lambda k n_psi,   k = mu/eps,
/// with L the bandwidth of the observer, and G the fed-forward yaw resistance (fed_forward()):
///   G = g3(n);   with Coulomb friction, for |n| < w0: g3(w0) sat(-lambda n_psi/w0)
/// w0 is the friction width of the mode. The steering command is
///   d = s c I'z w/(l_f g1(u_d)),
/// with s the share of the moment that the steering makes, and c = 2 (front-wheel drive: 1). With
/// independent readings, w changes by sqrt(2 E[w^2]) RMS from one sample to the next; correlated
/// readings change it less. The rate is 0 without steering, or if the steady speed needs no thrust.
double steering_rate_rms_degps(const Gains<double>& gains, const ConstraintContext& context);

/// Sets the friction width w of each mode that steers (Gains::friction_width_at()) and returns the
/// gains. The width of a mode is the smallest in the following range with which the mode's steering
/// rate is at most the limit times (1 + wider):
///   0.02 <= w <= min(10 c3 eps/(I'z mu), the highest yaw rate of the runs)
/// c3: Coulomb friction in yaw, I'z: yaw inertia (both divided by F_max); mu, eps: gains of the
/// heading law; S: its sliding variable. With a wider w, the fed-forward friction would compensate
/// little: at w = 10 c3 eps/(I'z mu), it grows with S only a tenth as fast as the corrective term
/// mu S/eps. If no w in this range meets the limit, w is the upper bound. w is 0.02 rad/s if there
/// is no limit, no steering or no Coulomb friction. If the gains have an observer, all modes get
/// the width of the mode whose steering command has the most noise.
Gains<double> with_friction_width(Gains<double> gains, const ConstraintContext& context,
                                  double wider = 0.0);

/// Largest heading error, rad, at which Coulomb friction c3 in yaw can hold the vehicle, if the
/// gains have no observer:
///   c3/(I'z lambda (mu/eps + c3/(I'z w0)))
/// I'z: yaw inertia (c3 and I'z divided by F_max); lambda, mu, eps: gains of the heading law; w0:
/// friction width of the mode. An observer makes this error decay.
double friction_error_rad(const Gains<double>& gains, const Plant<double>& plant, YawMode mode);

/// Largest rate of the steering, deg/s: that of the servo, but at most 2 d_max/T, with the largest
/// steering angle d_max and the servo's time constant T.
double servo_rate_degps(const Vehicle& vehicle, const Plant<double>& plant);

/// Warning `noise-beyond-servo`: with the tuned gains, sensor noise alone requests a higher RMS
/// rate of the steering than the servo can reach. The default limit of this rate permits that if
/// the feed-forward of the yaw resistance alone causes such a rate. Absent for vehicles without
/// steering, and for tunings without this limit (`--nominal`).
std::optional<Finding> noise_beyond_servo(const Vehicle& vehicle, const Plant<double>& plant,
                                          const Tuning& tuning);

}  // namespace awmr
