#include "awmr/tune/steering_rate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "awmr/control/controller.h"
#include "awmr/core/units.h"

namespace awmr {
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
///   sum over odd k of rho^k E[w He_k(z)]^2/k!,   He_k: Hermite polynomials
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

/// Standard normal distribution function. Do not replace it by that of
/// core/statistics/distributions.h, which needs Boost.Math: the report's WebAssembly build does not
/// have Boost.Math.
double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }
double normal_density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * pi<double>()); }

/// E[sat(x)] for a normal x with the mean m and the standard deviation s > 0. sat limits x to -1
/// ... 1.
double mean_saturated(double m, double s) {
  const double above = (m + 1.0) / s;
  const double below = (m - 1.0) / s;
  return (m + 1.0) * normal_cdf(above) - (m - 1.0) * normal_cdf(below) +
         s * (normal_density(above) - normal_density(below)) - 1.0;
}

/// Part of E[w^2] in steering_rate_rms_degps() that fed-forward friction causes, (rad/s^2)^2. While
/// a heading is held, the noise n of the yaw rate and n_psi of the heading are independent. With
/// the friction width w0 = rest_speed, the heading law feeds forward the friction
///   b = B if |n| < w0, else 0,   B = g3(w0)/I'z sat(-lambda n_psi/w0)
/// With b', n' and B' the values at the next sample, the part is half the mean square change of b
/// from one sample to the next,
///   E[b^2] - E[b b'] = P(|n| < w0) E[B^2] - P(|n| < w0, |n'| < w0) E[B B'],
/// plus the cross term of b with -lambda k n_psi, k = mu/eps.
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

/// As steering_rate_rms_degps(), for the mode in which the steering makes the fraction `share` of
/// the yaw moment.
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

/// Returns the share of the yaw moment that the steering makes, one value for each mode that
/// steers.
std::vector<double> steering_shares(const ConstraintContext& context) {
  if (!context.steers()) return {};
  if (context.mode) return {steering_share<double>(*context.mode)};
  return {steering_share<double>(YawMode::kSteering), steering_share<double>(YawMode::kCombined)};
}

/// Sets `width`, the friction width of one mode (the yaw rate below which Coulomb friction is fed
/// forward smoothly), to the smallest value in `widths` with which the RMS steering rate is at most
/// `limit_degps`. If there is none, sets it to the largest value. `share`: fraction of the yaw
/// moment that the steering makes in this mode.
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
  // A tenth, in the upper bound of the width (see with_friction_width() in the header).
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
    // If the gains have an observer, all modes get the friction width of the first mode in this
    // list, because its steering command has the most noise.
    if (gains.observer.is_on()) break;
  }
  const bool is_default =
      std::max(heading.friction_width_radps, heading.combined_friction_width_radps) <= kNarrowest;
  if (is_default) heading.combined_friction_width_radps = 0.0;
  return gains;
}

double friction_error_rad(const Gains<double>& gains, const Plant<double>& plant, YawMode mode) {
  const HeadingGains<double>& heading = gains.heading;
  const double friction = plant.yaw.coulomb / plant.inertia_norm;
  const double width_radps = gains.friction_width_at(steering_share<double>(mode));
  return friction / (heading.lambda * (heading.mu / heading.epsilon + friction / width_radps));
}

double servo_rate_degps(const Vehicle& vehicle, const Plant<double>& plant) {
  return std::min(vehicle.steering_max_rate_degps,
                  2.0 * degrees(plant.steering_max_rad) / plant.steering_time_constant_s);
}

std::optional<Finding> noise_beyond_servo(const Vehicle& vehicle, const Plant<double>& plant,
                                          const Tuning& tuning) {
  if (!vehicle.has_steering()) return std::nullopt;
  const auto rate = std::find_if(tuning.constraints.begin(), tuning.constraints.end(),
                                 [](const ConstraintReport& c) { return c.name == kSteeringRate; });
  const double servo_degps = servo_rate_degps(vehicle, plant);
  if (rate == tuning.constraints.end() || !(rate->value > servo_degps)) return std::nullopt;
  return Finding{
      "", 0, Severity::kWarning, "noise-beyond-servo",
      fmt::format("while a heading is held, sensor noise requests a steering rate of {:.3g} deg/s "
                  "RMS, but the servo turns at {:.3g} deg/s at most: it cannot follow, and wears. "
                  "Enter the measured `noise` and `noise_correlation_s` of the sensors in "
                  "vehicle.json, or use a gyroscope with less noise",
                  rate->value, servo_degps)};
}

}  // namespace awmr
