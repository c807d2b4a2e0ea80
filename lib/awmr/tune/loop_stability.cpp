#include "awmr/tune/loop_stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "awmr/core/units.h"
#include "awmr/model/steady.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/certificate.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/tuning_context.h"

namespace awmr {
namespace {

/// True if the heading loop is stable. The latency is compared with the delay margin, because
/// computing the poles of a loop with a latency of many samples takes long.
bool is_stable(const SampledHeadingLoop& loop) {
  SampledHeadingLoop prompt = loop;
  prompt.command_delay_s = 0.0;
  return damping_ratio(prompt) > 0.0 && loop.command_delay_s < delay_margin_s(prompt);
}

/// An unstable loop whose cause is the rate of its law.
UnstableLoop unstable_by(std::string name, const char* rate_name, double rate) {
  return {.name = std::move(name), .rate_name = rate_name, .rate = rate};
}

/// An unstable loop whose cause is its disturbance observer.
UnstableLoop unstable_by_observer(std::string name, double bandwidth_radps) {
  return {.name = std::move(name),
          .rate_name = "the bandwidth of its disturbance observer",
          .rate = bandwidth_radps,
          .unit = "rad/s"};
}

SampledHeadingLoop without_observer(SampledHeadingLoop loop) {
  loop.observer_radps = 0.0;
  return loop;
}

/// Returns the heading loop in a mode if it is unstable. The observer is the cause only if the loop
/// is stable without it at every examined yaw rate.
std::optional<UnstableLoop> unstable_heading(const Gains<double>& gains,
                                             const ConstraintContext& context, YawMode mode) {
  std::optional<UnstableLoop> by_observer;
  for (const double share : kRateShares) {
    const double rate_radps = examined_rate_radps(share, context);
    const SampledHeadingLoop loop = certified_loop(gains, context, context.plant, rate_radps, mode);
    if (is_stable(loop)) continue;
    std::string name =
        fmt::format("heading loop in mode {} at {:.3g} deg/s", name_of(mode), degrees(rate_radps));
    if (!is_stable(without_observer(loop))) {
      return unstable_by(std::move(name), "lambda + mu/epsilon", loop.lambda + loop.reaching_rate);
    }
    if (!by_observer) by_observer = unstable_by_observer(std::move(name), loop.observer_radps);
  }
  return by_observer;
}

/// Slope, with respect to the speed u, of the force that overcomes the surge resistance and the
/// back-EMF of n driven wheels, divided by m', 1/s: (g1'(u) + n k_e)/m'.
double surge_rate(const Plant<double>& plant, double speed_mps) {
  return (slope(plant.surge, speed_mps) + driven_wheels(plant) * plant.back_emf_s_per_m) /
         plant.mass_norm;
}

/// The speed loop at the speed of the context, with motor lag. `latency_s`: latency of the measured
/// speed.
SampledHeadingLoop sampled_speed_loop(const Gains<double>& gains, const ConstraintContext& context,
                                      double latency_s) {
  const double resistance_rate = surge_rate(context.plant, context.speed_mps);
  return {.reaching_rate = gains.speed.mu / gains.speed.epsilon,
          .resistance_rate = resistance_rate,
          .fed_forward_rate = resistance_rate,
          .servo_time_constant_s = context.plant.steering_time_constant_s,
          .sample_time_s = context.sample_time_s,
          .direct_share = 1.0,
          .motor_time_constant_s = context.motor_time_constant_s,
          .observer_radps = gains.observer.bandwidth_radps,
          .command_delay_s = latency_s};
}

std::optional<UnstableLoop> unstable_speed(const Gains<double>& gains,
                                           const ConstraintContext& context, double latency_s) {
  const SampledHeadingLoop loop = sampled_speed_loop(gains, context, latency_s);
  if (speed_damping_ratio(loop) > 0.0) return std::nullopt;
  std::string name = fmt::format("speed loop at {:.3g} m/s", context.speed_mps);
  return speed_damping_ratio(without_observer(loop)) > 0.0
             ? unstable_by_observer(std::move(name), loop.observer_radps)
             : unstable_by(std::move(name), "mu_s/epsilon_s", loop.reaching_rate);
}

}  // namespace

std::vector<UnstableLoop> unstable_loops(const Model& model, const ModeGains& gains,
                                         const LoopConditions& conditions,
                                         std::optional<YawMode> mode) {
  const auto plant = model.plant();
  const auto scenario = examined_scenario(model);
  if (!plant || !scenario) return {};
  ConstraintContext context = context_of({}, *plant, model.vehicle, {*scenario});
  add_conditions(conditions, context);
  std::optional<UnstableLoop> heading;
  std::optional<UnstableLoop> speed;
  for (const YawMode one : yaw_modes(model.vehicle)) {
    if (mode && one != *mode) continue;
    const Gains<double>& own = gains.in(one);
    if (!heading) heading = unstable_heading(own, context, one);
    if (!speed) speed = unstable_speed(own, context, conditions.speed_latency_s);
  }
  std::vector<UnstableLoop> unstable;
  if (heading) unstable.push_back(*heading);
  if (speed) unstable.push_back(*speed);
  return unstable;
}

}  // namespace awmr
