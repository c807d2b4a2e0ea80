#include "awmr/tune/tuning_context.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <variant>

#include "awmr/core/units.h"
#include "awmr/model/steady.h"
#include "awmr/tune/steering_rate.h"

namespace awmr {
namespace {

double largest_step_rad(const Scenario& scenario) {
  double largest = 0.0;
  double before = scenario.initial.psi_rad;
  for (const HeadingStep& step : std::get<HeadingSteps>(scenario.guidance).steps) {
    largest = std::max(largest, std::abs(wrap_angle(step.psi_rad - before)));
    before = step.psi_rad;
  }
  return largest;
}

/// Expected highest yaw rate in runs of the scenario, rad/s: the largest heading step per second,
/// or the heading-rate limit if that is lower.
double reached_radps(const Scenario& scenario) {
  const double in_a_second = largest_step_rad(scenario) / 1.0;
  return scenario.shaping ? std::min(in_a_second, scenario.shaping->rate_max_radps) : in_a_second;
}

}  // namespace

ConstraintContext context_of(const TuneOptions& options, const Plant<double>& plant,
                             const Vehicle& vehicle, const std::vector<Scenario>& scenarios) {
  ConstraintContext context{.form = options.form,
                            .margin = options.margin,
                            .plant = plant,
                            .has_steering = vehicle.has_steering(),
                            .mode = options.mode,
                            .sample_time_s = vehicle.sample_time_s,
                            .speed_mps = 0.0,
                            .step_rad = 0.0,
                            .fastest_radps = kSlowest_radps,
                            .limits = options.limits,
                            .wheel_force = vehicle.wheel_force};
  if (context.has_steering) {
    context.servo_rate_degps = servo_rate_degps(vehicle, plant);
  }
  for (const Scenario& s : scenarios) {
    context.speed_mps = std::max(context.speed_mps, s.speed_mps);
    context.step_rad = std::max(context.step_rad, largest_step_rad(s));
    context.fastest_radps = std::max(context.fastest_radps, reached_radps(s));
  }
  // The vehicle cannot turn faster than with the largest moment of the stronger mode.
  const auto steady = steady_rate(plant.yaw, largest_moment_m(context.own(), context.speed_mps));
  if (steady) context.fastest_radps = std::clamp(*steady, kSlowest_radps, context.fastest_radps);
  return context;
}

void add_conditions(const LoopConditions& c, ConstraintContext& context) {
  context.heading_noise_rad = radians(c.heading_noise_deg);
  context.yaw_rate_noise_radps = radians(c.yaw_rate_noise_degps);
  context.heading_correlation = noise_correlation(c.heading_correlation_s, context.sample_time_s);
  context.yaw_rate_correlation = noise_correlation(c.yaw_rate_correlation_s, context.sample_time_s);
  context.latency_s = std::max(c.heading_latency_s, c.yaw_rate_latency_s);
  context.motor_time_constant_s = c.motor_time_constant_s;
}

void limit_steering_rate(ConstraintContext& context) {
  if (context.limits.steering_rate_rms_degps || !context.steers()) return;
  constexpr double kShareOfServo = 0.9;
  constexpr double kOverFeedForward = 1.25;
  const Gains<double> none{{0.0, 0.0, 1.0}, {0.0, 1.0}};
  // The default limit leaves out Coulomb friction, because with_friction_width() selects a friction
  // width that keeps the noise of the fed-forward friction within the limit.
  ConstraintContext without_friction = context;
  without_friction.plant.yaw.coulomb = 0.0;
  context.limits.steering_rate_rms_degps =
      std::max(kShareOfServo * context.servo_rate_degps,
               kOverFeedForward * steering_rate_rms_degps(none, without_friction));
}

AxisForces<double> observer_limits(const ConstraintContext& context) {
  const Plant<double>& plant = context.plant;
  const double thrust = driven_wheels(plant) * forces_beyond_dead_zone(context.own()).hi -
                        plant.surge(context.speed_mps);
  const double moment_m = turning_authority_m(context.own(), context.speed_mps);
  const double friction_m = plant.yaw.coulomb + plant.yaw_scrub_m;
  return {.surge = kObserverShare * thrust,
          .yaw_m = friction_m + kObserverShare * std::max(moment_m - friction_m, 0.0)};
}

Status limit_observer(const ConstraintContext& context, std::optional<ObserverSearch>& observer) {
  if (!observer) return {};
  const AxisForces<double> defaults = observer_limits(context);
  const std::tuple<const char*, std::optional<double>*, double> limits[] = {
      {"yaw_max_m", &observer->yaw_max_m, defaults.yaw_m},
      {"surge_max", &observer->surge_max, defaults.surge}};
  for (const auto& [name, limit, by_default] : limits) {
    if (!*limit) *limit = by_default;
    if (**limit > 0.0) continue;
    return input_error(ErrorCode::kOutOfRange, "",
                       fmt::format("no default for the observer's {}: at {:g} m/s the wheels have "
                                   "no force left to compensate a disturbance; give slower "
                                   "scenarios",
                                   name, context.speed_mps));
  }
  return {};
}

}  // namespace awmr
