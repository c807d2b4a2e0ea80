#include "awmr/tune/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <utility>

#include "awmr/control/controller.h"
#include "awmr/core/units.h"

namespace awmr {
namespace {

ConstraintReport at_most(std::string name, double value, double limit, std::string meaning,
                         bool required = true) {
  return {.name = std::move(name),
          .value = value,
          .limit = limit,
          .margin = limit - value,
          .sense = Sense::kAtMost,
          .meaning = std::move(meaning),
          .required = required};
}

ConstraintReport at_least(std::string name, double value, double limit, std::string meaning) {
  return {.name = std::move(name),
          .value = value,
          .limit = limit,
          .margin = value - limit,
          .sense = Sense::kAtLeast,
          .meaning = std::move(meaning)};
}

double examined_rate_radps(double share, const ConstraintContext& context) {
  return std::max(share * context.fastest_radps, kSlowest_radps);
}

/// g3'(r)/I'z, g3'(r) = a3 b3 r^(b3 - 1) + 2 q3 r
double resistance_rate(const Plant<double>& plant, double rate_radps) {
  const Resistance<double>& g3 = plant.yaw;
  return (g3.alpha * g3.beta * std::pow(rate_radps, g3.beta - 1.0) +
          2.0 * g3.quadratic * rate_radps) /
         plant.inertia_norm;
}

/// A plant and a yaw rate at which its heading loop is examined.
struct ExaminedLoop {
  const Plant<double>* plant;
  double rate_radps;
};

/// The plant at each yaw rate of kRateShares.
std::vector<ExaminedLoop> at_all_rates(const Plant<double>& plant,
                                       const ConstraintContext& context) {
  std::vector<ExaminedLoop> loops;
  for (const double share : kRateShares) {
    loops.push_back({&plant, examined_rate_radps(share, context)});
  }
  return loops;
}

/// Adds each draw at the lowest and the highest yaw rate.
void add_draws(const ConstraintContext& context, std::vector<ExaminedLoop>& loops) {
  const Interval rates = examined_rates_radps(context);
  for (const double rate_radps : {rates.lo, rates.hi}) {
    for (const DrawnVehicle& drawn : context.draws) loops.push_back({&drawn.plant, rate_radps});
  }
}

/// Smallest damping ratio over the modes and the loops.
double heading_damping(const Gains<double>& gains, const ConstraintContext& context,
                       std::span<const ExaminedLoop> loops, double latency_s,
                       double motor_time_constant_s) {
  constexpr YawMode kAll[] = {YawMode::kDifferential, YawMode::kCombined, YawMode::kSteering};
  const auto modes = context.mode ? std::span(&*context.mode, 1)
                                  : std::span(kAll).first(context.has_steering ? 3 : 1);
  double worst = 1.0;
  for (const ExaminedLoop& examined : loops) {
    for (const YawMode mode : modes) {
      SampledHeadingLoop loop =
          heading_loop(gains, context, *examined.plant, examined.rate_radps, mode);
      loop.motor_time_constant_s = motor_time_constant_s;
      loop.command_delay_s = latency_s;
      worst = std::min(worst, damping_ratio(loop));
    }
  }
  return worst;
}

/// The constraints that are evaluated for one vehicle at a time: all except late damping, delay
/// margin and steering rate, which are evaluated over all vehicles of the context at once.
std::vector<ConstraintReport> constraints_with(const Gains<double>& gains,
                                               const ConstraintContext& context,
                                               const DrawnVehicle& vehicle);

/// Largest tau_turn of the modes steering and differential at steady speed, m.
struct Moments {
  double steering;
  double differential;
};
Moments moments_m(const DrawnVehicle& vehicle, double speed_mps) {
  const Plant<double>& plant = vehicle.plant;
  const Interval force = forces_beyond_dead_zone(vehicle);
  const double wheels = driven_wheels(plant);
  // Force of a wheel at constant speed, plus the compensation of its back-EMF.
  const double held = plant.surge(speed_mps) / wheels + plant.back_emf_s_per_m * speed_mps;
  return {.steering = steered_moment_m(vehicle, speed_mps),
          .differential = wheels * plant.half_track_m * std::min(force.hi - held, held - force.lo)};
}

}  // namespace

Interval forces_beyond_dead_zone(const DrawnVehicle& vehicle) {
  const double zone = vehicle.plant.wheel_dead_zone;
  return {std::min(vehicle.wheel_force.lo + zone, 0.0),
          std::max(vehicle.wheel_force.hi - zone, 0.0)};
}

double steered_moment_m(const DrawnVehicle& vehicle, double speed_mps) {
  const Plant<double>& plant = vehicle.plant;
  return plant.front_axle_m * plant.surge(speed_mps) *
         std::tan(steering_angle_factor(plant) * plant.steering_max_rad);
}

double residual(const ConstraintReport& c) {
  const double scale = std::max({std::abs(c.value), std::abs(c.limit), 1e-12});
  return -c.margin / scale;
}

double turning_authority_m(const DrawnVehicle& vehicle, double speed_mps,
                           std::optional<YawMode> mode) {
  const auto [steering, differential] = moments_m(vehicle, speed_mps);
  if (mode == YawMode::kSteering && steering > 0.0) return steering;
  if (mode == YawMode::kDifferential && differential > 0.0) return differential;
  if (!(steering > 0.0)) return differential;
  if (!(differential > 0.0)) return steering;
  return std::min(steering, differential);
}

double largest_moment_m(const DrawnVehicle& vehicle, double speed_mps) {
  const auto [steering, differential] = moments_m(vehicle, speed_mps);
  return std::max(steering, differential);
}

std::vector<ConstraintReport> constraints_of(const Gains<double>& gains,
                                             const ConstraintContext& context) {
  std::vector<ConstraintReport> worst = constraints_with(gains, context, context.own());
  for (const DrawnVehicle& drawn : context.draws) {
    const std::vector<ConstraintReport> here = constraints_with(gains, context, drawn);
    for (std::size_t i = 0; i < worst.size(); ++i) {
      if (residual(here[i]) > residual(worst[i])) worst[i] = here[i];
    }
  }
  if (context.latency_s > 0.0 || context.motor_time_constant_s > 0.0) {
    const Interval rates = examined_rates_radps(context);
    std::vector<ExaminedLoop> ends{{&context.plant, rates.lo}, {&context.plant, rates.hi}};
    std::vector<ExaminedLoop> loops = at_all_rates(context.plant, context);
    add_draws(context, ends);
    add_draws(context, loops);
    const double lag_s = context.motor_time_constant_s;
    worst.push_back(at_least(
        "late damping", heading_damping(gains, context, loops, context.latency_s, lag_s),
        context.limits.late_damping,
        "smallest damping ratio of the heading loop with latency and motor lag >= required"));
    const double doubled_s = 2.0 * context.latency_s + context.sample_time_s;
    worst.push_back(at_least("delay margin",
                             heading_damping(gains, context, ends, doubled_s, lag_s),
                             context.limits.delayed_damping,
                             "smallest damping ratio of the heading loop with motor lag and twice "
                             "the latency plus one sample >= required"));
  }
  if (const auto& limit = context.limits.steering_rate_rms_degps; limit && context.steers()) {
    worst.push_back(at_most(kSteeringRate, steering_rate_rms_degps(gains, context), *limit,
                            "RMS rate of the steering command due to sensor noise, deg/s"));
  }
  return worst;
}

SampledHeadingLoop heading_loop(const Gains<double>& gains, const ConstraintContext& context,
                                const Plant<double>& plant, double rate_radps, YawMode mode) {
  return {.lambda = gains.heading.lambda,
          .reaching_rate = gains.heading.mu / gains.heading.epsilon,
          .resistance_rate = resistance_rate(plant, rate_radps),
          .fed_forward_rate = resistance_rate(context.plant, rate_radps),
          .input_gain = context.plant.inertia_norm / plant.inertia_norm,
          .servo_time_constant_s = plant.steering_time_constant_s,
          .sample_time_s = context.sample_time_s,
          .direct_share = 1.0 - steering_share<double>(mode),
          .observer_radps = gains.observer.bandwidth_radps};
}

Interval examined_rates_radps(const ConstraintContext& context) {
  constexpr std::size_t kLast = std::size(kRateShares) - 1;
  return {examined_rate_radps(kRateShares[0], context),
          examined_rate_radps(kRateShares[kLast], context)};
}

namespace {

/// E[f(z) g(z)] for a standard normal z, by the midpoint rule over -6 ... 6.
template <class F, class G>
double mean_of_product(const F& f, const G& g) {
  constexpr int kIntervals = 240;
  constexpr double kReach = 6.0;
  constexpr double kWidth = 2.0 * kReach / kIntervals;
  double mean = 0.0;
  for (int i = 0; i < kIntervals; ++i) {
    const double z = -kReach + (i + 0.5) * kWidth;
    mean += kWidth * f(z) * g(z) * std::exp(-0.5 * z * z) / std::sqrt(2.0 * pi<double>());
  }
  return mean;
}

/// Lower bound of E[w(z) w(z')] for an odd function w and standard normals z, z' with the
/// correlation rho: the terms up to k = 7 of Mehler's series, all of which are >= 0,
///   sum over odd k of rho^k E[w He_k(z)]^2/k!
template <class W>
double mean_of_correlated(const W& w, double rho) {
  if (!(rho > 0.0)) return 0.0;
  struct Hermite {
    double (*polynomial)(double z);
    double factorial;
  };
  constexpr Hermite kOdd[] = {
      {[](double z) { return z; }, 1.0},
      {[](double z) { return z * (z * z - 3.0); }, 6.0},
      {[](double z) { return z * ((z * z - 10.0) * z * z + 15.0); }, 120.0},
      {[](double z) { return z * (((z * z - 21.0) * z * z + 105.0) * z * z - 105.0); }, 5040.0}};
  double mean = 0.0;
  double power = rho;
  for (const Hermite& hermite : kOdd) {
    const double coefficient = mean_of_product(w, hermite.polynomial);
    mean += power * coefficient * coefficient / hermite.factorial;
    power *= rho * rho;
  }
  return mean;
}

/// Standard normal distribution function. Do not replace it by that of core/distributions.h, which
/// needs Boost.Math: the report's WebAssembly build does not have Boost.Math.
double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }
double normal_density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * pi<double>()); }

/// E[sat(x)] for a normal x with the mean m and the standard deviation s > 0.
double mean_saturated(double m, double s) {
  const double above = (m + 1.0) / s;
  const double below = (m - 1.0) / s;
  return (m + 1.0) * normal_cdf(above) - (m - 1.0) * normal_cdf(below) +
         s * (normal_density(above) - normal_density(below)) - 1.0;
}

/// Part of E[w^2] in steering_rate_rms_degps() due to the friction that the heading law feeds
/// forward at rest, (rad/s^2)^2. With w0 = rest_speed, the fed-forward friction is
///   b = B if |n| < w0, else 0,   B = g3(w0)/I'z sat(-lambda n_psi/w0)
/// n and n_psi, the noise of yaw rate and heading, are independent; ' marks the next sample. The
/// part is half the mean square change of b from one sample to the next,
///   E[b^2] - E[b b'] = P(|n| < w0) E[B^2] - P(|n| < w0, |n'| < w0) E[B B'],
/// plus the cross term of b with -lambda k n_psi.
double resting_mean_square(const Resistance<double>& g3, const Gains<double>& gains,
                           const ConstraintContext& context) {
  const double slope = gains.heading.lambda * context.heading_noise_rad / g3.rest_speed;
  const double step = g3.at(g3.rest_speed) / context.plant.inertia_norm;
  const double reach = g3.rest_speed / std::max(context.yaw_rate_noise_radps, 1e-12);
  const double by_slope =
      gains.heading.lambda * gains.heading.mu / gains.heading.epsilon * context.heading_noise_rad;
  const auto rests = [&](double z) { return std::abs(z) < reach ? 1.0 : 0.0; };
  const auto friction = [&](double z) { return step * std::clamp(slope * z, -1.0, 1.0); };
  const auto linear = [&](double z) { return by_slope * z; };
  const double rests_share = 2.0 * normal_cdf(reach) - 1.0;
  double both_rest = rests_share * rests_share;
  if (const double rho = context.yaw_rate_correlation; rho > 0.0) {
    const double s = std::sqrt(1.0 - rho * rho);
    both_rest = mean_of_product(rests, [&](double z) {
      return normal_cdf((reach - rho * z) / s) - normal_cdf((-reach - rho * z) / s);
    });
  }
  double friction_pair = 0.0;  // E[B B']
  const double rho = context.heading_correlation;
  if (rho > 0.0 && slope > 0.0) {
    const double s = slope * std::sqrt(1.0 - rho * rho);
    friction_pair = mean_of_product(
        friction, [&](double z) { return step * mean_saturated(rho * slope * z, s); });
  }
  return rests_share * mean_of_product(friction, friction) - both_rest * friction_pair +
         2.0 * rests_share * mean_of_product(friction, linear) * (1.0 - rho);
}

/// steering_rate_rms_degps() in the mode in which the steering makes this share of the yaw moment.
double steering_rate_at(double share, const Gains<double>& gains,
                        const ConstraintContext& context) {
  const Plant<double>& plant = context.plant;
  const double tau_speed = plant.surge(context.speed_mps);
  if (!(tau_speed > 0.0)) return 0.0;
  const double k = gains.heading.mu / gains.heading.epsilon;
  const double rate_gain = gains.heading.lambda + k + gains.observer.bandwidth_radps;
  const Resistance<double> g3 = feed_forward(plant.yaw, gains.friction_width_at(share));
  const auto w = [&](double z) {  // z = n/sigma_r
    const double n = z * context.yaw_rate_noise_radps;
    const double moment = std::abs(n) < g3.rest_speed ? 0.0 : g3(n);
    return moment / plant.inertia_norm - rate_gain * n;
  };
  double mean_square = mean_of_product(w, w) - mean_of_correlated(w, context.yaw_rate_correlation);
  const double by_heading = gains.heading.lambda * k * context.heading_noise_rad;
  mean_square += by_heading * by_heading * (1.0 - context.heading_correlation);
  if (g3.rest_speed > 0.0) mean_square += resting_mean_square(g3, gains, context);
  const double per_moment =
      share * (plant.rear_driven > 0.0 ? 2.0 : 1.0) / (plant.front_axle_m * tau_speed);
  return degrees(per_moment * plant.inertia_norm * std::sqrt(2.0 * mean_square) /
                 context.sample_time_s);
}

/// Shares of the yaw moment that the steering makes in the modes that steer.
std::vector<double> steering_shares(const ConstraintContext& context) {
  if (!context.steers()) return {};
  if (context.mode) return {steering_share<double>(*context.mode)};
  return {steering_share<double>(YawMode::kSteering), steering_share<double>(YawMode::kCombined)};
}

/// Sets `width`, the friction width of the mode in which the steering makes the fraction `share` of
/// the yaw moment, to the smallest value in `widths` with which the RMS steering rate is at most
/// `limit_degps`. If there is none, it is set to the largest value.
Gains<double> with_smallest_width(Gains<double> gains, double HeadingGains<double>::*width,
                                  Interval widths, double limit_degps, double share,
                                  const ConstraintContext& context) {
  constexpr int kWidthBisections = 20;
  const auto is_calm = [&](double radps) {
    gains.heading.*width = radps;
    return steering_rate_at(share, gains, context) <= limit_degps;
  };
  if (is_calm(widths.lo) || widths.hi <= widths.lo) return gains;
  for (int i = 0; i < kWidthBisections && is_calm(widths.hi); ++i) {
    const double middle = std::sqrt(widths.lo * widths.hi);
    (is_calm(middle) ? widths.hi : widths.lo) = middle;
  }
  gains.heading.*width = widths.hi;
  return gains;
}

}  // namespace

double steering_rate_rms_degps(const Gains<double>& gains, const ConstraintContext& context) {
  double largest = 0.0;
  for (const double share : steering_shares(context)) {
    largest = std::max(largest, steering_rate_at(share, gains, context));
  }
  return largest;
}

Gains<double> with_friction_width(Gains<double> gains, const ConstraintContext& context,
                                  double wider) {
  // Fixes the largest width: with it, the fed-forward friction grows with S a tenth as fast as the
  // corrective term mu S/epsilon.
  constexpr double kMinFrictionShare = 0.1;
  HeadingGains<double>& heading = gains.heading;
  constexpr double kNarrowest = feed_forward_rest_speed<double>();
  heading.friction_width_radps = kNarrowest;
  heading.combined_friction_width_radps = 0.0;
  const auto& limit = context.limits.steering_rate_rms_degps;
  const Plant<double>& plant = context.plant;
  if (!limit || !(plant.yaw.coulomb > 0.0)) return gains;
  const double in_proportion =
      plant.yaw.coulomb * heading.epsilon / (plant.inertia_norm * heading.mu);
  const Interval widths{kNarrowest,
                        std::min(in_proportion / kMinFrictionShare, context.fastest_radps)};
  for (const double share : steering_shares(context)) {
    const bool is_own = share < 1.0 && !gains.observer.is_on();
    gains = with_smallest_width(gains,
                                is_own ? &HeadingGains<double>::combined_friction_width_radps
                                       : &HeadingGains<double>::friction_width_radps,
                                widths, *limit * (1.0 + wider), share, context);
    if (gains.observer.is_on())
      break;  // with an observer, all modes have the width of the first
              // one, whose steering command has the most noise
  }
  const bool is_default =
      std::max(heading.friction_width_radps, heading.combined_friction_width_radps) <= kNarrowest;
  if (is_default) heading.combined_friction_width_radps = 0.0;
  return gains;
}

namespace {

std::vector<ConstraintReport> constraints_with(const Gains<double>& gains,
                                               const ConstraintContext& context,
                                               const DrawnVehicle& vehicle) {
  const Plant<double>& known = context.plant;
  const Plant<double>& plant = vehicle.plant;
  const double sliding_s = gains.heading.sliding_time_constant_s();
  const double reaching_s = gains.heading.reaching_time_constant_s();
  const double speed_rate = known.mass_norm / plant.mass_norm *
                            (gains.speed.mu / gains.speed.epsilon + gains.observer.bandwidth_radps);
  const char* rate_name = gains.observer.is_on() ? "(mu_s/epsilon_s + L)" : "(mu_s/epsilon_s)";
  const double servo_s = context.steers() ? plant.steering_time_constant_s : 0.0;
  const double lag_s = std::max(servo_s, context.motor_time_constant_s) + context.latency_s +
                       context.sample_time_s / 2.0;
  const bool strict = context.form == ReachingForm::kStrict;
  const double zeta = context.limits.damping;
  return {
      at_most("T2 < T1 (paper)", reaching_s, context.margin * sliding_s,
              "epsilon/(2 mu) <= margin/lambda, s: V = S^2/2 decays faster than the heading error",
              !strict),
      at_most("T2 < T1 (strict)", 2.0 * reaching_s, context.margin * sliding_s,
              "epsilon/mu <= margin/lambda, s: S decays faster than the heading error", strict),
      at_least(
          "heading damping",
          heading_damping(gains, context, at_all_rates(plant, context), 0.0, 0.0),
          context.limits.damping,
          "smallest damping ratio of the sampled heading loop with hold and servo >= required"),
      at_most("speed gain", speed_rate * context.sample_time_s, kSpeedGainPerSample,
              fmt::format("{} T_s <= 0.5: gain margin 4 of the sampled speed loop", rate_name)),
      at_most("speed lag", speed_rate * lag_s, 1.0 / (4.0 * zeta * zeta),
              fmt::format(
                  "{} (T + latency + T_s/2) <= 1/(4 zeta^2): damping ratio of the speed loop >= "
                  "zeta = {:g}; T: larger time constant of servo and motors",
                  rate_name, zeta)),
      at_least("mu dominates", gains.heading.mu,
               kUnmodelledShare * plant.yaw(context.fastest_radps) / known.inertia_norm,
               fmt::format("mu >= 20 % of g3({:.3g} deg/s)/I'z, rad/s^2",
                           degrees(context.fastest_radps))),
      at_least("mu_s dominates", gains.speed.mu,
               kUnmodelledShare * plant.surge(context.speed_mps) / known.mass_norm,
               "mu_s >= 20 % of g1(u_d)/m', m/s^2"),
      at_most("noise gain",
              known.inertia_norm * gains.heading.lambda * gains.heading.mu / gains.heading.epsilon *
                  context.heading_noise_rad,
              context.limits.noise_share *
                  turning_authority_m(vehicle, context.speed_mps, context.mode),
              fmt::format("tau_turn due to {:g} deg of heading noise <= {:g} % of the largest yaw "
                          "moment of the weaker mode, m",
                          degrees(context.heading_noise_rad), 100.0 * context.limits.noise_share)),
  };
}

}  // namespace

std::vector<double> residuals(const std::vector<ConstraintReport>& constraints) {
  std::vector<double> values;
  for (const ConstraintReport& c : constraints) {
    if (c.required) values.push_back(residual(c));
  }
  return values;
}

}  // namespace awmr
