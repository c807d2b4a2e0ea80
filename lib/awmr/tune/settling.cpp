#include "awmr/tune/settling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "awmr/core/option_text.h"
#include "awmr/tune/pole_placement.h"

namespace awmr {
namespace {

double settled_share(const ObjectiveSetting& setting, const Gains<double>& gains) {
  const auto all = run_all(setting, draw_noise(setting), std::span(&gains, 1));
  const std::vector<ModeScore>& scores = all.front();
  const auto settled = std::ranges::count_if(
      scores, [](const ModeScore& score) { return score.metrics.completed && !score.has_failed; });
  return static_cast<double>(settled) / static_cast<double>(scores.size());
}

/// The scenario with `factor` times the time for each heading.
Scenario stretched(Scenario scenario, double factor) {
  scenario.duration_s *= factor;
  for (HeadingStep& step : std::get<HeadingSteps>(scenario.guidance).steps) step.t_s *= factor;
  return scenario;
}

std::optional<SettlingChange> more_time(const ObjectiveSetting& setting, const Gains<double>& gains,
                                        double share) {
  for (const double factor : {2.0, 4.0}) {
    ObjectiveSetting longer = setting;
    for (Scenario& scenario : longer.scenarios) scenario = stretched(scenario, factor);
    if (settled_share(longer, gains) < share) continue;
    return SettlingChange{
        "/scenarios",
        fmt::format("scenarios of {:g} s in place of {:g} s, with all times in "
                    "proportion",
                    longer.scenarios.front().duration_s, setting.scenarios.front().duration_s)};
  }
  return std::nullopt;
}

std::optional<SettlingChange> no_rate_limit(const ObjectiveSetting& setting,
                                            const Gains<double>& gains, double share) {
  ObjectiveSetting stepped = setting;
  std::optional<double> limit_degps;
  for (Scenario& scenario : stepped.scenarios) {
    if (!scenario.shaping) continue;
    limit_degps = degrees(scenario.shaping->rate_max_radps);
    scenario.shaping.reset();
  }
  if (!limit_degps || settled_share(stepped, gains) < share) return std::nullopt;
  return SettlingChange{"/scenarios",
                        fmt::format("{} in place of the heading-rate limit of {:.3g} deg/s",
                                    option_text("heading_rate_limit none"), *limit_degps)};
}

bool meets_constraints(const Gains<double>& gains, const ConstraintContext& context) {
  return std::ranges::max(residuals(constraints_of(gains, context))) <= 0.0;
}

std::optional<SettlingChange> an_observer(const ObjectiveSetting& setting,
                                          const ConstraintContext& context,
                                          const Gains<double>& gains, double share) {
  if (gains.observer.is_on()) return std::nullopt;
  const Plant<double>& plant = context.plant;
  const double authority_m = turning_authority_m(context.own(), context.speed_mps);
  const double thrust =
      driven_wheels(plant) * context.wheel_force.hi - plant.surge(context.speed_mps);
  if (!(thrust > 0.0)) return std::nullopt;
  for (const double bandwidth_radps : {0.5, 1.0, 2.0, 4.0}) {
    if (bandwidth_radps * context.sample_time_s >= 1.0) break;
    // The constraints limit the sum of the rates of law and observer, so the law is made slower.
    for (const double slower : {1.0, 0.7, 0.5}) {
      Gains<double> observed = gains;
      observed.observer = {bandwidth_radps, kObserverShare * authority_m, kObserverShare * thrust};
      observed.heading.lambda *= slower;
      observed.heading.epsilon /= slower;
      const double speed_rate = gains.speed.mu / gains.speed.epsilon - bandwidth_radps;
      if (speed_rate > 0.0) observed.speed.epsilon = gains.speed.mu / speed_rate;
      if (!meets_constraints(observed, context) || settled_share(setting, observed) < share) {
        continue;
      }
      return SettlingChange{"/observer", fmt::format("{} (here with a bandwidth of {:g} rad/s)",
                                                     option_text("observer"), bandwidth_radps)};
    }
  }
  return std::nullopt;
}

std::optional<SettlingChange> one_mode(const ObjectiveSetting& setting,
                                       const ConstraintContext& context, double share) {
  if (context.mode || !context.has_steering) return std::nullopt;
  for (const YawMode mode : setting.modes()) {
    ConstraintContext alone = context;
    alone.mode = mode;
    ObjectiveSetting runs = setting;
    runs.mode = mode;
    for (const Gains<double>& gains : starting_poles(alone)) {
      if (!meets_constraints(gains, alone) || settled_share(runs, gains) < share) continue;
      return SettlingChange{"/mode",
                            fmt::format("{}, gains for this mode only",
                                        option_text("mode " + std::string(name_of(mode))))};
    }
  }
  return std::nullopt;
}

std::optional<SettlingChange> a_higher_steering_rate(const ObjectiveSetting& setting,
                                                     const ConstraintContext& context,
                                                     const Gains<double>& gains, double share) {
  if (!context.limits.steering_rate_rms_degps || !(context.plant.yaw.coulomb > 0.0)) {
    return std::nullopt;
  }
  for (const double factor : {1.2, 2.0, 5.0, 20.0}) {
    ConstraintContext higher = context;
    double& limit = *higher.limits.steering_rate_rms_degps;
    limit = std::ceil(factor * limit);
    const Gains<double> narrower = with_friction_width(gains, higher);
    if (settled_share(setting, narrower) < share) continue;
    return SettlingChange{"/limits/steering_rate_rms_degps",
                          fmt::format("`limits/steering_rate_rms_degps` {:g}", limit)};
  }
  return std::nullopt;
}

}  // namespace

std::vector<SettlingChange> changes_that_settle(const ObjectiveSetting& setting,
                                                const ConstraintContext& context,
                                                const Gains<double>& gains, double share) {
  std::vector<SettlingChange> changes;
  for (auto& change :
       {more_time(setting, gains, share), no_rate_limit(setting, gains, share),
        an_observer(setting, context, gains, share), one_mode(setting, context, share),
        a_higher_steering_rate(setting, context, gains, share)}) {
    if (change) changes.push_back(*change);
  }
  return changes;
}

std::string describe(const std::vector<SettlingChange>& changes, std::string_view runs) {
  std::vector<std::string> texts;
  for (const SettlingChange& change : changes) texts.push_back(change.text);
  return fmt::format("{} lets {} settle: {}",
                     texts.size() == 1 ? "This change" : "Each of these changes", runs,
                     fmt::join(texts, "; "));
}

std::string no_change_settles(std::string_view runs) {
  return fmt::format(
      "None of these changes lets {} settle: 4 times the time, no heading-rate limit, an observer, "
      "gains for one mode only",
      runs);
}

}  // namespace awmr
