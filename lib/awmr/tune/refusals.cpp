#include "awmr/tune/refusals.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "awmr/core/option_text.h"
#include "awmr/tune/goals.h"

namespace awmr {
namespace {

std::string in_words(const Gains<double>& g) {
  return fmt::format(
      "lambda {:.4g}, mu {:.4g}, epsilon {:.4g}, mu_s {:.4g}, epsilon_s {:.4g}{}", g.heading.lambda,
      g.heading.mu, g.heading.epsilon, g.speed.mu, g.speed.epsilon,
      g.observer.is_on() ? fmt::format(", observer {:.4g} rad/s", g.observer.bandwidth_radps) : "");
}

/// What helps where a constraint leaves no gains: the limit to relax, and what of the vehicle causes it.
std::string advice_on(std::string_view constraint) {
  struct Advice {
    std::string_view constraint, limit, cause;
  };
  static constexpr Advice kAdvice[] = {
      {"late damping", "limits/late_damping", "the readings are late (latency_s of vehicle.json)"},
      {"delay margin", "limits/delayed_damping",
       "the readings are late (latency_s of vehicle.json)"},
      {"noise gain", "limits/noise_share",
       "heading noise uses much of the available yaw moment (noise of vehicle.json)"},
      {"steering rate", "limits/steering_rate_rms_degps",
       "the readings are noisy for this servo (noise of vehicle.json)"},
      {"heading damping", "limits/damping",
       "samples or servo are slow, or the yaw resistance is uncertain"},
      {"speed lag", "bounds of speed_mu and speed_epsilon", "servo, motors or readings are slow"},
      {"speed gain", "bounds of speed_mu and speed_epsilon", "samples are long"},
      {"mu dominates", "bounds of mu", "yaw resistance asks for it"},
      {"mu_s dominates", "bounds of speed_mu", "surge resistance asks for it"}};
  const auto* known = std::ranges::find(kAdvice, constraint, &Advice::constraint);
  if (known == std::end(kAdvice))
    return "raise the margin, choose form 'paper' or widen the bounds";
  return fmt::format("relax {} of tune.json; {}", known->limit, known->cause);
}

/// The goal, if any, that keeps the nearest gains from being taken.
std::optional<tl::unexpected<Error>> goal_missed(const SearchResult& found, const Evaluation& e,
                                                 const Objective& objective,
                                                 const std::vector<Scenario>& scenarios) {
  const std::vector<GoalInMode> goals = by_mode(objective.goals(), objective.modes());
  std::size_t worst = goals.size();
  for (std::size_t i = 0; i < goals.size(); ++i) {
    if (goals[i].goal->is_soft || e.goal_quantile[i] <= 1.0) continue;
    if (worst == goals.size() || e.goal_quantile[i] > e.goal_quantile[worst]) worst = i;
  }
  if (worst == goals.size()) return std::nullopt;
  const bool is_led = std::ranges::any_of(
      scenarios, [](const Scenario& one) { return one.name.ends_with(kLedSuffix); });
  return refusal(fmt::format(
      "no gains within the bounds reach the goal \"{}\": the nearest of {} ({}) need {:.3g} "
      "times its limits; make it soft, raise its limits, or give more evaluations{}",
      goals[worst].name(), found.evaluations, in_words(found.nearest.gains), e.goal_quantile[worst],
      is_led ? "; of the default scenarios one leads the heading no faster than was measured, "
               "which takes its time: " +
                   option_text("heading_rate_limit") + " none leaves it out"
             : ""));
}

}  // namespace

tl::unexpected<Error> infeasible(const Candidate& nearest, const ConstraintContext& context) {
  const std::vector<ConstraintReport> all = constraints_of(nearest.gains, context);
  const ConstraintReport* worst = nullptr;
  double worst_residual = 0.0;
  for (const ConstraintReport& c : all) {
    const std::vector<double> residual = residuals({c});
    if (residual.empty() || residual.front() <= worst_residual) continue;
    worst = &c;
    worst_residual = residual.front();
  }
  const std::string name = worst ? worst->name : "none";
  return refusal(
      fmt::format("no gains within the bounds meet the constraints: the nearest ({}) "
                  "break '{}', {:.4g} against a limit of {:.4g} ({}); {}",
                  in_words(nearest.gains), name, worst ? worst->value : 0.0,
                  worst ? worst->limit : 0.0, worst ? worst->meaning : "", advice_on(name)));
}

tl::unexpected<Error> not_found(const SearchResult& found, const Objective& objective,
                                const std::vector<Scenario>& scenarios) {
  const Evaluation e = objective(found.nearest.gains);
  if (auto missed = goal_missed(found, e, objective, scenarios)) return *missed;
  const std::string gains = in_words(found.nearest.gains);
  if (!e.valid) {
    return refusal(fmt::format(
        "no gains keep every run finite: runs with the nearest of {} ({}) break off; give "
        "slower scenarios or narrower bounds",
        found.evaluations, gains));
  }
  const bool is_activity = found.broken_most.starts_with("activity");
  return refusal(fmt::format(
      "no gains within the bounds keep every limit: the nearest of {} ({}) break '{}' by {:.0f} %; "
      "{}, or give more evaluations",
      found.evaluations, gains, found.broken_most, 100.0 * found.broken_by,
      is_activity ? "raise activity_max of tune.json" : advice_on(found.broken_most)));
}

}  // namespace awmr
