#include "awmr/tune/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "awmr/core/units.h"
#include "awmr/model/steady.h"
#include "awmr/tune/steering_rate.h"

namespace awmr {

ConstraintReport at_most(std::string name, double value, double limit, std::string meaning,
                         bool required) {
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

namespace {

/// Slope of the yaw resistance with respect to the yaw rate, at the yaw rate r, divided by the yaw
/// inertia I'z, 1/s: g3'(r)/I'z.
double resistance_rate(const Plant<double>& plant, double rate_radps) {
  return slope(plant.yaw, rate_radps) / plant.inertia_norm;
}

struct ExaminedLoop {
  const Plant<double>* plant;
  double rate_radps;
};

std::vector<ExaminedLoop> at_all_rates(const Plant<double>& plant,
                                       const ConstraintContext& context) {
  std::vector<ExaminedLoop> loops;
  for (const double share : kRateShares) {
    loops.push_back({&plant, examined_rate_radps(share, context)});
  }
  return loops;
}

/// Adds to `loops` the heading loops of each drawn vehicle at the lowest and the highest yaw rate.
void add_draws(const ConstraintContext& context, std::vector<ExaminedLoop>& loops) {
  const Interval rates = examined_rates_radps(context);
  for (const double rate_radps : {rates.lo, rates.hi}) {
    for (const DrawnVehicle& drawn : context.draws) loops.push_back({&drawn.plant, rate_radps});
  }
}

/// Smallest damping ratio of the loops in all tuned modes.
double heading_damping(const Gains<double>& gains, const ConstraintContext& context,
                       std::span<const ExaminedLoop> loops, double latency_s,
                       double motor_time_constant_s, double (*damping)(const SampledHeadingLoop&)) {
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
      worst = std::min(worst, damping(loop));
    }
  }
  return worst;
}

/// Largest yaw moments tau_turn (divided by F_max, m) of the modes steering and differential at
/// steady speed.
struct Moments {
  double steering;
  double differential;
};
Moments moments_m(const DrawnVehicle& vehicle, double speed_mps) {
  const Plant<double>& plant = vehicle.plant;
  const Interval force = forces_beyond_dead_zone(vehicle);
  const double wheels = driven_wheels(plant);
  // Force that each wheel needs at constant speed, including the part that compensates back-EMF.
  const double held = plant.surge(speed_mps) / wheels + plant.back_emf_s_per_m * speed_mps;
  return {.steering = steered_moment_m(vehicle, speed_mps),
          .differential = wheels * plant.half_track_m * std::min(force.hi - held, held - force.lo)};
}

/// Speed loop of one vehicle. The gain depends on its m', because the controller uses the nominal
/// m'.
struct SpeedLoop {
  /// Gain (mu_s/eps_s + L) m'_nominal/m', with L the bandwidth of the observer.
  double gain_per_s;
  const char* gain_name;  ///< formula of the gain, for messages
  double lag_s;           ///< T + latency + T_s/2
};
SpeedLoop speed_loop(const Gains<double>& gains, const ConstraintContext& context,
                     const Plant<double>& plant) {
  const double servo_s = context.steers() ? plant.steering_time_constant_s : 0.0;
  return {.gain_per_s = context.plant.mass_norm / plant.mass_norm *
                        (gains.speed.mu / gains.speed.epsilon + gains.observer.bandwidth_radps),
          .gain_name = gains.observer.is_on() ? "(mu_s/epsilon_s + L)" : "(mu_s/epsilon_s)",
          .lag_s = std::max(servo_s, context.motor_time_constant_s) + context.latency_s +
                   context.sample_time_s / 2.0};
}

ConstraintReport speed_gain(const SpeedLoop& loop, double sample_time_s) {
  return at_most(
      "speed gain", loop.gain_per_s * sample_time_s, kSpeedGainPerSample,
      fmt::format("{} T_s <= 0.5, T_s: sample time; the sampled speed loop then has a gain margin "
                  "of at least 4",
                  loop.gain_name));
}

ConstraintReport speed_lag(const SpeedLoop& loop, double zeta) {
  return at_most(
      "speed lag", loop.gain_per_s * loop.lag_s, 1.0 / (4.0 * zeta * zeta),
      fmt::format("{} (T + latency + T_s/2) <= 1/(4 zeta^2), so that the damping ratio of the "
                  "speed loop is >= zeta = {:g}; T: larger time constant of servo and motors, T_s: "
                  "sample time",
                  loop.gain_name, zeta));
}

ConstraintReport noise_gain(const Gains<double>& gains, const ConstraintContext& context,
                            const DrawnVehicle& vehicle) {
  return at_most(
      "noise gain",
      context.plant.inertia_norm * gains.heading.lambda * gains.heading.mu / gains.heading.epsilon *
          context.heading_noise_rad,
      context.limits.noise_share * turning_authority_m(vehicle, context.speed_mps, context.mode),
      fmt::format("yaw moment that the heading law requests for a heading error of {:g} deg (the "
                  "noise) <= {:g} % of the largest yaw moment of the weaker mode (steering or "
                  "differential); both moments divided by F_max, in m",
                  degrees(context.heading_noise_rad), 100.0 * context.limits.noise_share));
}

/// The constraints that are evaluated for one vehicle at a time. constraints_of() adds late
/// damping, delayed damping and steering rate for all vehicles of the context together.
std::vector<ConstraintReport> constraints_with(const Gains<double>& gains,
                                               const ConstraintContext& context,
                                               const DrawnVehicle& vehicle) {
  const Plant<double>& known = context.plant;
  const Plant<double>& plant = vehicle.plant;
  const double sliding_s = gains.heading.sliding_time_constant_s();
  const double reaching_s = gains.heading.reaching_time_constant_s();
  const SpeedLoop speed = speed_loop(gains, context, plant);
  const bool strict = context.form == ReachingForm::kStrict;
  return {
      at_most("T2 < T1 (paper)", reaching_s, context.margin * sliding_s,
              "epsilon/(2 mu) <= margin/lambda (in s; lambda, mu, epsilon: gains of the heading "
              "law): the square of the sliding variable S decays faster than the heading error",
              !strict),
      at_most("T2 < T1 (strict)", 2.0 * reaching_s, context.margin * sliding_s,
              "epsilon/mu <= margin/lambda (in s; lambda, mu, epsilon: gains of the heading law): "
              "the sliding variable S decays faster than the heading error",
              strict),
      at_least(
          "heading damping",
          heading_damping(gains, context, at_all_rates(plant, context), 0.0, 0.0, damping_ratio),
          context.limits.damping,
          "smallest damping ratio of the sampled heading loop, with the hold of the commands "
          "between samples and with the servo, >= limits/damping of tune.json"),
      speed_gain(speed, context.sample_time_s),
      speed_lag(speed, context.limits.damping),
      at_least("mu dominates", gains.heading.mu,
               kUnmodelledShare * plant.yaw(context.fastest_radps) / known.inertia_norm,
               fmt::format("gain mu >= 20 % of g3({:.3g} deg/s)/I'z, rad/s^2, so that the heading "
                           "law overcomes errors of the yaw resistance g3",
                           degrees(context.fastest_radps))),
      at_least("mu_s dominates", gains.speed.mu,
               kUnmodelledShare * plant.surge(context.speed_mps) / known.mass_norm,
               "gain mu_s >= 20 % of g1(u_d)/m', m/s^2, so that the speed law overcomes errors of "
               "the surge resistance g1"),
      noise_gain(gains, context, vehicle),
  };
}

}  // namespace

Interval forces_beyond_dead_zone(const DrawnVehicle& vehicle) {
  return forces_beyond_dead_zone(vehicle.wheel_force, vehicle.plant.wheel_dead_zone);
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
        "late damping",
        heading_damping(gains, context, loops, context.latency_s, lag_s, dominant_damping_ratio),
        context.limits.late_damping,
        "smallest damping ratio of the slow poles of the heading loop, with latency and motor lag, "
        ">= limits/late_damping of tune.json"));
    const double doubled_s = 2.0 * context.latency_s + context.sample_time_s;
    worst.push_back(at_least(
        "delayed damping", heading_damping(gains, context, ends, doubled_s, lag_s, damping_ratio),
        context.limits.delayed_damping,
        "smallest damping ratio of the heading loop, with motor lag and with twice the latency "
        "plus one sample, >= limits/delayed_damping of tune.json"));
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

double examined_rate_radps(double share, const ConstraintContext& context) {
  return std::max(share * context.fastest_radps, kSlowest_radps);
}

Interval examined_rates_radps(const ConstraintContext& context) {
  constexpr std::size_t kLast = std::size(kRateShares) - 1;
  return {examined_rate_radps(kRateShares[0], context),
          examined_rate_radps(kRateShares[kLast], context)};
}

std::vector<double> residuals(const std::vector<ConstraintReport>& constraints) {
  std::vector<double> values;
  for (const ConstraintReport& c : constraints) {
    if (c.required) values.push_back(residual(c));
  }
  return values;
}

double violation(const Gains<double>& gains, const ConstraintContext& context) {
  const std::vector<double> all = residuals(constraints_of(gains, context));
  return *std::max_element(all.begin(), all.end());
}

bool meets_constraints(const Gains<double>& gains, const ConstraintContext& context) {
  return violation(gains, context) <= 0.0;
}

}  // namespace awmr
