/// Constraints of the gains that need no simulation. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"
#include "awmr/tune/drawn_vehicle.h"
#include "awmr/tune/sampled_loop.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Largest latency, in samples, for which the damping is computed.
inline constexpr int kMostLatencySamples = 20;
/// Share of the modelled resistance that the corrective terms must exceed. It is larger than the
/// model error that validate accepts by default on the trials (0.15).
inline constexpr double kUnmodelledShare = 0.2;
inline constexpr const char* kSteeringRate = "steering rate";
/// Largest mu_s/eps_s T_s. The sampled integrator is unstable from 2 on, so the gain margin is 4.
inline constexpr double kSpeedGainPerSample = 0.5;

/// Yaw rates at which the heading loop is examined, as a fraction of the highest rate of the runs.
/// None is below kSlowest_radps, which sensors cannot distinguish from rest.
inline constexpr double kRateShares[] = {1.0 / 60.0, 1.0 / 12.0, 1.0 / 3.0, 1.0};
inline constexpr double kSlowest_radps = radians(1.0);

/// Inputs of the constraints other than the gains.
struct ConstraintContext {
  ReachingForm form = ReachingForm::kStrict;  ///< the form of T2 < T1 that is required
  double margin = 0.8;                        ///< reaching time constant <= margin T1, in (0, 1)
  Plant<double> plant{};                      ///< the model's own values, which the laws use
  bool has_steering = true;              ///< false: only wheel-force differences turn the vehicle
  std::optional<YawMode> mode = {};      ///< the only mode; absent: all modes of the vehicle
  double sample_time_s = 0.01;           ///< T_s, > 0
  double speed_mps = 1.0;                ///< largest u_d of the scenarios, >= 0
  double step_rad = radians(60.0);       ///< largest change of the commanded heading, >= 0
  double fastest_radps = radians(60.0);  ///< highest yaw rate of the runs, > 0
  TuningLimits limits = {};              ///< no steering rate: not limited
  Interval wheel_force{-1.0, 1.0};       ///< F' of one wheel over F_max
  double heading_noise_rad = radians(1.0);     ///< standard deviation of a reading, >= 0
  double yaw_rate_noise_radps = radians(0.5);  ///< the same, >= 0
  double heading_correlation = 0.0;            ///< of two readings T_s apart, [0, 1)
  double yaw_rate_correlation = 0.0;           ///< the same
  double latency_s = 0.0;                      ///< of heading and yaw rate, >= 0
  double motor_time_constant_s = 0.0;          ///< >= 0
  std::vector<DrawnVehicle> draws = {};        ///< further vehicles to which the constraints apply

  DrawnVehicle own() const { return {plant, wheel_force}; }
  /// Whether the servo acts in any of the modes.
  bool steers() const { return has_steering && mode != YawMode::kDifferential; }
};

/// Largest tau_turn of the weaker of steering and differential at steady speed u_d, m. A way to
/// turn without any moment there (steering at rest) is ignored. With `mode` steering or
/// differential: of that one.
///   steering      l_f g1(u_d) tan(d_max/2)
///   differential  4 d min(F'max - g1/4, g1/4 - F'min)
/// Front-wheel drive: tan(d_max), and 2 for 4. Back-EMF: g1/4 + k_e u_d for g1/4.
double turning_authority_m(const DrawnVehicle& vehicle, double speed_mps,
                           std::optional<YawMode> mode = {});

/// Largest tau_turn of the stronger of steering and differential, m, or of the only one that the
/// vehicle has.
double largest_moment_m(const DrawnVehicle& vehicle, double speed_mps);

/// Every constraint, as value <= limit or value >= limit (ConstraintReport::sense):
///   T2 < T1 (paper)    eps/(2 mu) <= margin/lambda                                    [paper (95)]
///   T2 < T1 (strict)   eps/mu     <= margin/lambda
///   heading damping    smallest zeta of the sampled loop >= damping
///   late damping       the same with latency and motor lag, if any, >= late_damping
///   delay margin       that with twice the latency plus one sample >= delayed_damping
///   speed gain         (mu_s/eps_s) T_s <= 0.5
///   speed lag          (mu_s/eps_s) (T + T_s/2) <= 1/(4 zeta^2)
///   mu dominates       mu >= 0.2 g3(r)/I'z, g3 the plant's, r the highest rate         [paper (88)]
///   mu_s dominates     mu_s >= 0.2 g1(u_d)/m', g1 the plant's                        [paper (102)]
///   noise gain         I'z lambda (mu/eps) sigma <= noise_share turning_authority_m(), sigma: heading
///                      noise
///   steering rate      steering_rate_rms_degps() <= the limit, if any
/// with the limits of TuningLimits.
///
/// Each is reported for the vehicle with the smallest margin: the context's own or one of its
/// draws. The laws use the parameters of the context's own plant. With another plant the loop gain
/// changes by the ratio of the two m' (speed loop: a factor on mu_s/eps_s) or of the two I'z
/// (heading loop: SampledHeadingLoop::input_gain).
///
/// Late damping and the delay margin are computed at the lowest and the highest yaw rate, because
/// their matrices grow with the latency. For the context's own plant, late damping is computed at
/// all rates.
///
/// T2 < T1: both forms are reported, one of them is required.
///
/// Heading damping is the smallest over the vehicle's modes and the yaw rates of kRateShares,
/// because the slope of g3 depends on the rate.
///
/// Speed gain: with g1 cancelled after the delay of the hold, the pole of the loop is
///   z = 1 - k_s (1 - exp(-a T_s))/a,   k_s = mu_s/eps_s,   a = g1'/m' >= 0,
/// so z is in [1 - k_s T_s, 1).
///
/// Speed lag: k_s/(s (1 + tau s)) closes to tau s^2 + s + k_s, so zeta = 1/(2 sqrt(k_s tau)). Motor
/// lag and latency, if any, are added to T. With a servo, its T is used in place of an unknown
/// motor lag.
///
/// An observer of bandwidth L is part of the sampled heading loop. In the speed loop it replaces
/// k_s by k_s + L: with d_hat the command is -(k_s + L) e_u - k_s L times the integral of e_u, and
/// to first order the lag acts on the faster part. It adds no gain on the measured heading.
///
/// Noise gain is the law's gain from psi to tau_turn. Beyond the limit, compass noise alone
/// saturates the actuators.
///
/// mu has no upper limit from the actuators' authority: the allocation clips a larger request. The
/// paper's mu (I'z mu = 0.64 m) exceeds the authority in every mode.
std::vector<ConstraintReport> constraints_of(const Gains<double>& gains,
                                             const ConstraintContext& context);

/// The heading loop of `plant` at a yaw rate, whose law uses the context's own plant. With hold and
/// servo, without latency and motor lag.
SampledHeadingLoop heading_loop(const Gains<double>& gains, const ConstraintContext& context,
                                const Plant<double>& plant, double rate_radps, YawMode mode);

/// The lowest and the highest yaw rate at which the heading loop is examined.
Interval examined_rates_radps(const ConstraintContext& context);

/// RMS rate of the steering command, deg/s, due to sensor noise with the standard deviations
/// sigma_psi and sigma_r while a heading is held in steering mode. From the yaw-rate noise n and
/// the heading noise n_psi, the law computes
///   w = G(n, n_psi)/I'z - (lambda + k + L) n - lambda k n_psi,   k = mu/eps,
///   G = g3(n);   with Coulomb friction, for |n| < rest: g3(rest) sat(-lambda n_psi/rest)
/// (fed_forward() with the intent S). The command is d = c I'z w/(l_f g1(u_d)), c = 2 (front-wheel
/// drive: 1). From one sample to the next, w changes by sqrt(2 E[w^2]) RMS. If the only mode is
/// combined, the rate is half of that. With gains of 0, only g3 contributes. 0 without steering, or
/// without thrust to steer with. Assumes that the vehicle does not turn: motion due to the noise is
/// neglected.
double steering_rate_rms_degps(const Gains<double>& gains, const ConstraintContext& context);

/// Returns the gains with the smallest friction width w0 that meets the limit of the steering rate,
/// or a limit larger by the share `wider`:
///   0.02 <= w0 <= min(10 c3 eps/(I'z mu), the highest yaw rate of the runs)
/// At the first bound the friction fed forward grows with S a tenth as fast as the corrective term.
/// If no w0 in this range meets the limit, w0 is the upper end. Without a limit or without Coulomb
/// friction, w0 is 0.02.
Gains<double> with_friction_width(Gains<double> gains, const ConstraintContext& context,
                                  double wider = 0.0);

/// (value - limit)/max(|value|, |limit|) of each required constraint: <= 0 exactly when it holds.
std::vector<double> residuals(const std::vector<ConstraintReport>& constraints);

}  // namespace awmr
