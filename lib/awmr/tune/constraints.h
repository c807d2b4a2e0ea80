/// Constraints of the gains that are computed from formulas, without simulation. Private to tune/.
#pragma once

#include <limits>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/units.h"
#include "awmr/model/dynamics.h"
#include "awmr/tune/sampled_loop.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// A vehicle on which gains are tuned or evaluated.
struct DrawnVehicle {
  Plant<double> plant{};
  /// Range of the force of one wheel, divided by F_max. The allocation clips the wheel forces to
  /// it.
  Interval wheel_force{-1.0, 1.0};
};

/// Largest latency, in samples, for which the damping is computed.
inline constexpr int kMaxLatencySamples = 20;
/// mu I'z must be at least this share of the modelled yaw resistance, and mu_s m' of the surge
/// resistance. If mu or mu_s were smaller, the control laws could not compensate errors of the
/// modelled resistance. Chosen above the relative error of the model's predictions that `awmr
/// validate` accepts by default (0.15).
inline constexpr double kUnmodelledShare = 0.2;
inline constexpr const char* kSteeringRate = "steering rate";
/// Largest permitted (mu_s/eps_s) T_s, the gain of the speed loop times the sample time. The
/// sampled loop becomes unstable at 2, so 0.5 leaves a gain margin of at least 4.
inline constexpr double kSpeedGainPerSample = 0.5;

/// Yaw rates at which the heading loop is examined, as fractions of the highest expected yaw rate
/// of the runs. Rates below kSlowest_radps are replaced by kSlowest_radps, because sensors cannot
/// distinguish lower rates from rest.
inline constexpr double kRateShares[] = {1.0 / 60.0, 1.0 / 12.0, 1.0 / 3.0, 1.0};
inline constexpr double kSlowest_radps = radians(1.0);

/// Inputs of the constraints besides the gains.
struct ConstraintContext {
  /// Required form of the condition T2 < T1, T1 = 1/lambda: on the decay of S^2/2 or of S.
  ReachingForm form = ReachingForm::kStrict;
  /// Largest ratio of the reaching time constant T2 to T1, in (0, 1).
  double margin = 0.8;
  Plant<double> plant{};     ///< the identified plant, which the controller uses
  bool has_steering = true;  ///< false: only wheel-force differences turn the vehicle
  /// the only mode that is tuned; absent: all modes of the vehicle
  std::optional<YawMode> mode = {};
  double sample_time_s = 0.01;           ///< T_s, > 0
  double speed_mps = 1.0;                ///< largest u_d of the scenarios, >= 0
  double step_rad = radians(60.0);       ///< largest change of the commanded heading, >= 0
  double fastest_radps = radians(60.0);  ///< highest yaw rate of the runs, > 0
  TuningLimits limits = {};  ///< Without steering_rate_rms_degps, the steering rate has no limit.
  /// Highest rate of the steering servo, deg/s. Infinite without steering.
  double servo_rate_degps = std::numeric_limits<double>::infinity();
  Interval wheel_force{-1.0, 1.0};  ///< range of F', the force of one wheel divided by F_max
  double heading_noise_rad = radians(1.0);  ///< standard deviation of the heading noise, >= 0
  /// Standard deviation of the yaw-rate noise, >= 0.
  double yaw_rate_noise_radps = radians(0.5);
  /// Correlation of the heading noise of two readings that are one sample time T_s apart, [0, 1).
  double heading_correlation = 0.0;
  /// Correlation of the yaw-rate noise of two readings that are one sample time T_s apart, [0, 1).
  double yaw_rate_correlation = 0.0;
  /// Latency of the readings of heading and yaw rate, s, >= 0.
  double latency_s = 0.0;
  double motor_time_constant_s = 0.0;  ///< time constant of the motors, s, >= 0
  /// Drawn vehicles: the gains must also meet the constraints on each of them.
  std::vector<DrawnVehicle> draws = {};

  /// The nominal vehicle: the identified plant with the vehicle's own wheel forces.
  DrawnVehicle own() const { return {plant, wheel_force}; }
  /// True if the steering servo acts in any of the tuned modes.
  bool steers() const { return has_steering && mode != YawMode::kDifferential; }
};

Interval forces_beyond_dead_zone(const DrawnVehicle& vehicle);

/// Returns the factor k of the steering's yaw moment, which is proportional to tan(k d_r) at the
/// steering angle d_r: 1/2, or 1 with front-wheel drive.
inline double steering_angle_factor(const Plant<double>& plant) {
  return plant.rear_driven > 0.0 ? 0.5 : 1.0;
}

/// Largest yaw moment of the steering at the steady speed u_d, divided by F_max, m: l_f g1(u_d)
/// tan(k d_max), with k from steering_angle_factor().
double steered_moment_m(const DrawnVehicle& vehicle, double speed_mps);

/// Returns the largest yaw moment tau_turn (divided by F_max, m) at the steady speed u_d: that of
/// the weaker mode, steering or differential (the mode with the smaller largest yaw moment). If
/// `mode` is one of the two modes, it returns the moment of this mode. A mode that has no moment at
/// that speed (steering at rest) is ignored.
///   steering      l_f g1(u_d) tan(d_max/2)
///   differential  4 d min(F'max - g1/4, g1/4 - F'min)
/// F'max and F'min are the limits of the wheel force after subtracting the motor dead zone. If only
/// the front wheels are driven, tan(d_max) replaces tan(d_max/2), and 2 replaces each 4. If the
/// motors have back-EMF (k_e per wheel), k_e u_d is added to g1/4. l_f: centre of gravity to front
/// axle, d: half of the track width, d_max: steering stop, g1: surge resistance.
double turning_authority_m(const DrawnVehicle& vehicle, double speed_mps,
                           std::optional<YawMode> mode = {});

/// Returns the largest yaw moment tau_turn (divided by F_max, m) at the steady speed u_d of the
/// stronger of the two modes steering and differential.
double largest_moment_m(const DrawnVehicle& vehicle, double speed_mps);

/// The constraints value <= limit and value >= limit.
ConstraintReport at_most(std::string name, double value, double limit, std::string meaning = {},
                         bool required = true);
ConstraintReport at_least(std::string name, double value, double limit, std::string meaning = {});

/// Computes every constraint. ConstraintReport::meaning has its formula or description. T_s: sample
/// time. Late and delayed damping exist only with latency or motor lag, the steering rate only
/// with a limit and a mode that steers.
///
/// Each constraint is reported for the vehicle (nominal or drawn) that is nearest to the limit, or
/// violates it most. The controller always uses the nominal plant. On a drawn plant, the gain
/// mu_s/eps_s of the speed loop is therefore multiplied by the ratio m' nominal/drawn. The gain of
/// the heading loop is multiplied by the ratio I'z nominal/drawn (SampledHeadingLoop::input_gain).
///
/// T2 < T1 [paper (95)]: both forms are reported; only ConstraintContext::form is required.
/// mu dominates the disturbance [paper (88)], mu_s that of the speed loop [paper (102)].
///
/// Heading damping is the smallest over the vehicle's modes and the yaw rates of kRateShares. It
/// depends on the rate through the slope of the yaw resistance g3. For the nominal plant, late
/// damping is also computed at all these rates. For drawn plants, late and delayed damping are
/// computed at the lowest and the highest rate only, to save time: their matrices grow with the
/// latency.
///
/// Speed gain: the speed law cancels g1 with the delay of the hold, so the pole of the loop is
///   z = 1 - k_s (1 - exp(-a T_s))/a,   k_s = mu_s/eps_s,   a = g1'/m' >= 0,
/// so z is in [1 - k_s T_s, 1).
///
/// Speed lag: the open loop k_s/(s (1 + tau s)), tau = T + latency + T_s/2, has the closed-loop
/// polynomial tau s^2 + s + k_s, so its damping ratio is 1/(2 sqrt(k_s tau)). T is the larger of
/// the time constants of servo and motors.
///
/// An observer of bandwidth L is part of the sampled heading loop, and adds no gain on the measured
/// heading. In the speed loop, k_s + L replaces k_s: law and observer together command -(k_s + L)
/// e_u - k_s L integral(e_u) for the speed error e_u. To first order, the lag acts on the first
/// term only.
///
/// mu dominates, mu_s dominates: g3 and g1 are those of the examined vehicle, I'z and m' nominal.
///
/// Noise gain: I'z lambda mu/eps is the gain of the heading law from the heading psi to the yaw
/// moment tau_turn.
///
/// I'z mu may exceed the largest yaw moment, because the allocation clips the request. With the
/// paper's mu (I'z mu = 0.64 m), it does so in every mode.
std::vector<ConstraintReport> constraints_of(const Gains<double>& gains,
                                             const ConstraintContext& context);

/// Returns the heading loop of `plant` at a yaw rate and in a mode, with hold and servo, but
/// without latency and motor lag. The heading law uses the nominal plant of the context.
SampledHeadingLoop heading_loop(const Gains<double>& gains, const ConstraintContext& context,
                                const Plant<double>& plant, double rate_radps, YawMode mode);

double examined_rate_radps(double share, const ConstraintContext& context);

Interval examined_rates_radps(const ConstraintContext& context);

/// Residual of a constraint: -margin/max(|value|, |limit|), with ConstraintReport::margin. The
/// residual is <= 0 exactly if the constraint is met.
double residual(const ConstraintReport& constraint);

/// The residual of each required constraint.
std::vector<double> residuals(const std::vector<ConstraintReport>& constraints);

/// Largest residual of the required constraints.
double violation(const Gains<double>& gains, const ConstraintContext& context);

/// True if the gains meet every required constraint.
bool meets_constraints(const Gains<double>& gains, const ConstraintContext& context);

}  // namespace awmr
