#include <algorithm>
#include <tuple>
#include <utility>

#include "awmr/control/heading_lqi.h"
#include "awmr/model/paper_gains.h"
#include "awmr/tune/tuning_steps.h"

namespace awmr {
namespace {

/// Weights of the LQI law by Bryson's rule, from the acceptable values at TradeOff::named.
LqiWeights<double> lqi_weights(const ConstraintContext& context) {
  const double error_rad = context.step_rad / 6.0;
  return {.heading_rad = error_rad,
          .yaw_rate_radps = context.step_rad / 1.5,
          .integral_rad_s = 4.0 * error_rad,
          .tau_turn_m = 0.25 * turning_authority_m(context.own(), context.speed_mps, context.mode)};
}

}  // namespace

std::vector<FrontPoint> front_of(std::vector<FrontPoint> points) {
  std::ranges::sort(points, {}, [](const FrontPoint& one) {
    return std::pair(one.point.settling_time_s, one.point.control_variation);
  });
  std::vector<FrontPoint> front;
  for (const FrontPoint& one : points) {
    const double variation = one.point.control_variation;
    if (!front.empty() && !(variation < front.back().point.control_variation)) continue;
    front.push_back(one);
  }
  return front;
}

TradeOff trade_off_of(const Objective& searched, const ConstraintContext& context,
                      std::vector<FrontPoint> met, const Gains<double>& tuned,
                      const Gains<double>& baseline) {
  TradeOff result{.front = front_of(std::move(met)), .named = {}};
  const auto add = [&result](const char* name, const Evaluation& evaluation) {
    if (evaluation.valid) result.named.push_back({name, evaluation.trade_off});
  };
  add("tuned", searched(tuned));
  add("baseline", searched.baseline());
  add("paper", searched(kPaperGains));
  const LqiWeights<double> weights = lqi_weights(context);
  const double inertia_norm = context.plant.inertia_norm;
  if (!(weights.heading_rad > 0.0 && weights.tau_turn_m > 0.0) ||
      !settles_when_sampled(lqi_gains(weights, inertia_norm), context.sample_time_s)) {
    return result;
  }
  ObjectiveSetting by_lqi = searched.setting();
  by_lqi.goals.clear();
  for (Scenario& scenario : by_lqi.scenarios) scenario.control.lqi = weights;
  add("lqi", Objective(std::move(by_lqi), baseline).baseline());
  return result;
}

}  // namespace awmr
