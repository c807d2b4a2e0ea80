/// Constraints of the gains that need no simulation. Private to tune/.
#pragma once

#include <vector>

#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"
#include "awmr/tune/drawn_vehicle.h"
#include "awmr/tune/sampled_loop.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Beyond so many samples of latency it is not worked out.
inline constexpr int kMostLateSamples = 20;
/// Part of the modelled resistance that the corrective terms have to dominate: more than the model
/// may be wrong by on its own trials (0.15 is validate's default tolerance).
inline constexpr double kUnmodelledShare = 0.2;
inline constexpr const char* kSteeringRate = "steering rate";
/// mu_s/eps_s T_s at most: the sampled integrator is unstable from 2 on, so the gain margin is 4.
inline constexpr double kSpeedGainPerSample = 0.5;

/// Yaw rates at which the heading loop is examined, over the fastest that the runs reach; none is
/// slower than kSlowest_radps, which sensors cannot distinguish from rest.
inline constexpr double kRateShares[] = {1.0 / 60.0, 1.0 / 12.0, 1.0 / 3.0, 1.0};
inline constexpr double kSlowest_radps = radians(1.0);

/// Inputs of the constraints other than the gains.
struct ConstraintContext {
  ReachingForm form = ReachingForm::kStrict;  ///< the form of T2 < T1 that is required
  double margin = 0.8;                        ///< reaching time constant <= margin T1, in (0, 1)
  Plant<double> plant{};                      ///< the model's own values, which the laws know
  bool has_steering = true;              ///< false: only wheel-force differences turn the vehicle
  std::optional<YawMode> mode = {};      ///< the only one; absent: all that the vehicle has
  double sample_time_s = 0.01;           ///< T_s, > 0
  double speed_mps = 1.0;                ///< largest u_d of the scenarios, >= 0
  double step_rad = radians(60.0);       ///< largest change of the commanded heading, >= 0
  double fastest_radps = radians(60.0);  ///< yaw rate that the runs reach, > 0
  TuningLimits limits = {};              ///< without a steering rate: that is not limited
  Interval wheel_force{-1.0, 1.0};       ///< F' of one wheel over F_max
  double heading_noise_rad = radians(1.0);     ///< standard deviation of a reading, >= 0
  double yaw_rate_noise_radps = radians(0.5);  ///< the same, >= 0
  double heading_correlation = 0.0;            ///< of two readings T_s apart, [0, 1)
  double yaw_rate_correlation = 0.0;           ///< the same
  double latency_s = 0.0;                      ///< of heading and yaw rate, >= 0
  double motor_time_constant_s = 0.0;          ///< >= 0
  std::vector<DrawnVehicle> draws = {};        ///< further ones that the gains have to suit

  DrawnVehicle own() const { return {plant, wheel_force}; }
  /// Whether the servo acts in any of the modes.
  bool steers() const { return has_steering && mode != YawMode::kDifferential; }
};

/// Largest tau_turn by the weaker of steering and differential at steady speed u_d, m; one that has
/// none there (steering at rest) is passed over. Of one mode alone: steering or differential.
///   steering      l_f g1(u_d) tan(d_max/2)
///   differential  4 d min(F'max - g1/4, g1/4 - F'min)
/// Front-wheel drive: tan(d_max), and 2 for 4. Back-EMF: g1/4 + k_e u_d for g1/4.
double turning_authority_m(const DrawnVehicle& vehicle, double speed_mps,
                           std::optional<YawMode> mode = {});

/// Largest tau_turn of the stronger of the two, m; of steering or differential alone where the vehicle has
/// one of them.
double largest_moment_m(const DrawnVehicle& vehicle, double speed_mps);

/// Every constraint, as value <= limit or value >= limit (ConstraintReport::sense):
///   T2 < T1 (paper)    eps/(2 mu) <= margin/lambda                                    [paper (95)]
///   T2 < T1 (strict)   eps/mu     <= margin/lambda
///   heading damping    smallest zeta of the sampled loop >= damping
///   late damping       the same with latency and motor lag, where there is any, >= late_damping
///   delay margin       that with twice the latency and a sample more >= delayed_damping
///   speed gain         (mu_s/eps_s) T_s <= 0.5
///   speed lag          (mu_s/eps_s) (T + T_s/2) <= 1/(4 zeta^2)
///   mu dominates       mu >= 0.2 g3(r)/I'z, g3 the plant's, r the fastest              [paper (88)]
///   mu_s dominates     mu_s >= 0.2 g1(u_d)/m', g1 the plant's                        [paper (102)]
///   noise gain         I'z lambda (mu/eps) sigma <= noise_share turning_authority_m(), sigma: heading
///                      noise
///   steering rate      steering_rate_rms_degps() <= the limit, where there is one
/// with the limits of TuningLimits.
///
/// Each is of the vehicle, out of the context's own and its draws, that leaves it the least.
/// The laws know the context's own alone, so with another plant the loop's gain is its m' or I'z
/// over the plant's: (mu_s/eps_s) times it in the speed loop, SampledHeadingLoop::input_gain in the
/// heading loop.
///
/// Late damping, whose matrix grows with the latency, and the delay margin are those of the context's
/// own plant and of each draw at the least and the largest of the yaw rates; late damping of its own
/// at all of them.
///
/// T2 < T1: one of the two forms is required, both are given.
///
/// Heading damping is that of the worst of the vehicle's modes' actuation and of the yaw rates of
/// kRateShares, since the slope of g3 depends on the rate.
///
/// Speed gain: with g1 cancelled with the hold's delay the loop's pole is
///   z = 1 - k_s (1 - exp(-a T_s))/a,   k_s = mu_s/eps_s,   a = g1'/m' >= 0,
/// so z is in [1 - k_s T_s, 1).
///
/// Speed lag: k_s/(s (1 + tau s)) closes to tau s^2 + s + k_s, so zeta = 1/(2 sqrt(k_s tau)). The
/// motors' lag and the latency, where they are given, are added to T; the servo's T stands in for the
/// motors' where there is a servo.
///
/// An observer of bandwidth L is part of the sampled heading loop; in the speed loop it makes
/// k_s + L of k_s: with d_hat the command is -(k_s + L) e_u - k_s L times its integral, and to first
/// order the lag costs that of the faster part. Its gain on readings of the heading is none.
///
/// Noise gain is the law's gain from psi to tau_turn: beyond the limit the noise of a compass alone
/// drives the actuators to their stops.
///
/// mu by itself has no upper limit from the actuators' authority: what they cannot deliver the
/// allocation clips, and the paper's own mu (I'z mu = 0.64 m) is beyond it in every mode.
std::vector<ConstraintReport> constraints_of(const Gains<double>& gains,
                                             const ConstraintContext& context);

/// The heading loop of a plant at a yaw rate, by gains that know the context's own plant: with hold and servo, without
/// latency and motor lag.
SampledHeadingLoop heading_loop(const Gains<double>& gains, const ConstraintContext& context,
                                const Plant<double>& plant, double rate_radps, YawMode mode);

/// The slowest and the fastest yaw rate at which the heading loop is examined.
Interval examined_rates_radps(const ConstraintContext& context);

/// RMS rate of the steering command, deg/s, from independent readings of standard deviations sigma_psi and
/// sigma_r while a heading is held in steering mode. With n the noise of the yaw rate, the law makes
///   w = G(n, n_psi)/I'z - (lambda + k + L) n - lambda k n_psi,   k = mu/eps,
///   G = g3(n);   of a curve that jumps at rest, for |n| < rest: g3(rest) sat(-lambda n_psi/rest)
/// of it (fed_forward() with the intent S), the command is d = c I'z w/(l_f g1(u_d)), c = 2 (front-wheel drive:
/// 1), and from one sample to the next it changes by sqrt(2 E[w^2]) of that; in combined mode alone, by half.
/// With gains of 0 it is what g3 makes by itself. 0 without steering, or where the vehicle has no thrust to steer
/// with. The vehicle is taken to be at rest on its heading: noise that turns it is not counted.
double steering_rate_rms_degps(const Gains<double>& gains, const ConstraintContext& context);

/// The gains with the narrowest friction width that keeps the limit of the steering rate, or one wider
/// by the share `wider`:
///   0.02 <= w0 <= 10 c3 eps/(I'z mu)
/// At the upper end the friction fed forward grows with S a tenth as fast as the corrective term.
/// Where that does not keep the limit either, w0 is the upper end; without a limit or Coulomb friction, 0.02.
Gains<double> with_friction_width(Gains<double> gains, const ConstraintContext& context,
                                  double wider = 0.0);

/// (value - limit)/max(|value|, |limit|) of each required constraint: <= 0 exactly when it holds.
std::vector<double> residuals(const std::vector<ConstraintReport>& constraints);

}  // namespace awmr
