#include "awmr/tune/settling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>

#include "awmr/core/option_text.h"
#include "awmr/tune/pole_placement.h"
#include "awmr/tune/relaxation.h"
#include "awmr/tune/steering_rate.h"

namespace awmr {
namespace {

/// The scenario with its duration, and the time for each heading, multiplied by `factor`.
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
    if (!enough_settle(longer, gains, share)) continue;
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
  if (!limit_degps || !enough_settle(stepped, gains, share)) return std::nullopt;
  return SettlingChange{"/scenarios",
                        fmt::format("{} in place of the heading-rate limit of {:.3g} deg/s",
                                    option_text("heading_rate_limit none"), *limit_degps)};
}

bool meets_constraints(const Gains<double>& gains, const ConstraintContext& context) {
  return std::ranges::max(residuals(constraints_of(gains, context))) <= 0.0;
}

/// Gains by pole placement that meet the constraints.
std::vector<Gains<double>> feasible_poles(const ConstraintContext& context,
                                          const ObserverGains<double>& observer = {}) {
  std::vector<Gains<double>> feasible;
  for (const Gains<double>& gains : starting_poles(context, observer)) {
    if (meets_constraints(gains, context)) feasible.push_back(gains);
  }
  return feasible;
}

/// True if at least `share` of the runs settle with one of the sets of gains.
bool any_settles(const ObjectiveSetting& setting, const std::vector<Gains<double>>& gains,
                 double share) {
  return std::ranges::any_of(
      gains, [&](const Gains<double>& one) { return enough_settle(setting, one, share); });
}

/// Gains by pole placement with an observer: for each bandwidth, in increasing order, the gains that
/// meet the constraints. Empty if the vehicle has no force left to compensate a disturbance.
std::vector<std::vector<Gains<double>>> observed_poles(const ConstraintContext& context) {
  const Plant<double>& plant = context.plant;
  const double authority_m = turning_authority_m(context.own(), context.speed_mps);
  const double thrust = driven_wheels(plant) * forces_beyond_dead_zone(context.own()).hi -
                        plant.surge(context.speed_mps);
  std::vector<std::vector<Gains<double>>> poles;
  if (!(thrust > 0.0)) return poles;
  for (const double bandwidth_radps : {0.5, 1.0, 2.0, 4.0}) {
    if (bandwidth_radps * context.sample_time_s >= 1.0) break;
    poles.push_back(feasible_poles(
        context, {bandwidth_radps, kObserverShare * authority_m, kObserverShare * thrust}));
  }
  return poles;
}

/// Returns a bandwidth, rad/s, of an observer that lets at least `share` of the runs settle,
/// together with gains by pole placement. Empty if there is none.
std::optional<double> settling_bandwidth_radps(
    const ObjectiveSetting& setting, const std::vector<std::vector<Gains<double>>>& observed,
    double share) {
  for (const std::vector<Gains<double>>& gains : observed) {
    if (any_settles(setting, gains, share)) return gains.front().observer.bandwidth_radps;
  }
  return std::nullopt;
}

/// Returns the change "tune with an observer", if an observer lets the runs settle. If it does not
/// suffice, the limit of the steering rate is also relaxed.
std::optional<SettlingChange> an_observer(const ObjectiveSetting& setting,
                                          const ConstraintContext& context,
                                          const Gains<double>& gains, double share) {
  const auto change = [](double bandwidth_radps, const std::string& more) {
    return SettlingChange{"/observer",
                          fmt::format("{}{} (confirmed with a bandwidth of {:g} rad/s)",
                                      option_text("observer"), more, bandwidth_radps)};
  };
  if (gains.observer.is_on()) return std::nullopt;
  if (const auto bandwidth = settling_bandwidth_radps(setting, observed_poles(context), share)) {
    return change(*bandwidth, "");
  }
  for (const std::vector<RelaxedLimit>& numbers : relaxed_limits(context)) {
    for (const RelaxedLimit& limit : numbers) {
      if (!limit.is_steering_rate) continue;
      const auto observed = observed_poles(limit.context);
      if (const auto bandwidth = settling_bandwidth_radps(setting, observed, share)) {
        return change(*bandwidth, fmt::format(" together with `{}` {:g}", limit.key, limit.number));
      }
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
    if (!any_settles(runs, feasible_poles(alone), share)) continue;
    return SettlingChange{"/mode", fmt::format("{}, gains for this mode only",
                                               option_text("mode " + std::string(name_of(mode))))};
  }
  return std::nullopt;
}

/// For each limit that can be relaxed (relaxed_limits()), returns the strictest of the tried values
/// with which the runs settle.
std::vector<SettlingChange> relaxed(const ObjectiveSetting& setting,
                                    const ConstraintContext& context, const Gains<double>& gains,
                                    double share) {
  std::vector<SettlingChange> changes;
  for (const std::vector<RelaxedLimit>& numbers : relaxed_limits(context)) {
    const auto settles = std::ranges::find_if(numbers, [&](const RelaxedLimit& limit) {
      const Gains<double> same = with_friction_width(gains, limit.context);
      return (meets_constraints(same, limit.context) && enough_settle(setting, same, share)) ||
             any_settles(setting, feasible_poles(limit.context), share);
    });
    if (settles == numbers.end()) continue;
    changes.push_back({fmt::format("/{}", settles->key),
                       fmt::format("`{}` {:g}", settles->key, settles->number)});
  }
  return changes;
}

}  // namespace

double settled_share(const ObjectiveSetting& setting, const Gains<double>& gains) {
  const auto all = run_all(setting, draw_noise(setting), std::span(&gains, 1));
  const std::vector<ModeScore>& scores = all.front();
  const auto settled = std::ranges::count_if(
      scores, [](const ModeScore& score) { return score.metrics.completed && !score.has_failed; });
  return static_cast<double>(settled) / static_cast<double>(scores.size());
}

bool enough_settle(const ObjectiveSetting& setting, const Gains<double>& gains, double share) {
  constexpr std::size_t kFirst = 3;
  if (setting.vehicles.size() > kFirst) {
    ObjectiveSetting first = setting;
    first.vehicles.resize(kFirst);
    const double all = static_cast<double>(setting.vehicles.size());
    const double missing = (1.0 - settled_share(first, gains)) * kFirst / all;
    constexpr double kRounding = 1e-9;
    if (missing > 1.0 - share + kRounding) return false;
  }
  return settled_share(setting, gains) >= share;
}

double settled_share_without_noise(ObjectiveSetting setting, const Gains<double>& gains) {
  for (Scenario& scenario : setting.scenarios) {
    if (!scenario.sensors) continue;
    for (Channel* sensor :
         {&scenario.sensors->heading, &scenario.sensors->yaw_rate, &scenario.sensors->speed}) {
      sensor->noise = 0.0;
    }
  }
  return settled_share(setting, gains);
}

ObjectiveSetting runs_in(ObjectiveSetting setting, const std::string& scenario, YawMode mode) {
  setting.mode = mode;
  setting.goals.clear();
  if (!scenario.empty()) {
    std::erase_if(setting.scenarios, [&](const Scenario& s) { return s.name != scenario; });
  }
  return setting;
}

ObjectiveSetting on_few_vehicles(ObjectiveSetting setting) {
  constexpr std::size_t kVehicles = 13;
  if (setting.vehicles.size() > kVehicles) setting.vehicles.resize(kVehicles);
  return setting;
}

bool observer_settles_more(const ObjectiveSetting& setting, const ConstraintContext& context,
                           const Gains<double>& gains) {
  if (gains.observer.is_on()) return false;
  const std::vector<std::vector<Gains<double>>> observed = observed_poles(context);
  for (const Scenario& scenario : setting.scenarios) {
    for (const YawMode mode : setting.modes()) {
      const ObjectiveSetting runs = runs_in(setting, scenario.name, mode);
      if (settled_share(runs, gains) >= kSettledShare) continue;
      if (settling_bandwidth_radps(on_few_vehicles(runs), observed, kSettledShare)) return true;
    }
  }
  return false;
}

std::vector<SettlingChange> changes_that_settle(const ObjectiveSetting& setting,
                                                const ConstraintContext& context,
                                                const Gains<double>& gains, double share) {
  std::vector<SettlingChange> changes;
  for (auto& change :
       {more_time(setting, gains, share), no_rate_limit(setting, gains, share),
        an_observer(setting, context, gains, share), one_mode(setting, context, share)}) {
    if (change) changes.push_back(*change);
  }
  std::ranges::copy(relaxed(setting, context, gains, share), std::back_inserter(changes));
  return changes;
}

std::string describe(const std::vector<SettlingChange>& changes, std::string_view runs) {
  std::vector<std::string> texts;
  for (const SettlingChange& change : changes) texts.push_back(change.text);
  return fmt::format("{} lets {} settle ({}): {}",
                     texts.size() == 1 ? "This change" : "Each of these changes", runs,
                     kSmallerMaySuffice, fmt::join(texts, "; "));
}

std::string no_change_settles(std::string_view runs) {
  return fmt::format(
      "None of these changes lets {} settle: four times the duration, no heading-rate limit, an "
      "observer, gains for one mode only, relaxed limits",
      runs);
}

}  // namespace awmr
