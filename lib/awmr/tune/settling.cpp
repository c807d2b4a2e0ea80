#include "awmr/tune/settling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "awmr/core/option_text.h"
#include "awmr/core/units.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/pole_placement.h"
#include "awmr/tune/relaxation.h"
#include "awmr/tune/steering_rate.h"
#include "awmr/tune/tuning_context.h"

namespace awmr {
namespace {

/// The headings of a scenario with their times, for messages.
std::string manoeuvre(const Scenario& scenario) {
  std::string text = fmt::format("at {:g} m/s", scenario.speed_mps);
  for (const HeadingStep& step : std::get<HeadingSteps>(scenario.guidance).steps) {
    text += fmt::format(", {:g} deg from {:g} s", degrees(step.psi_rad), step.t_s);
  }
  return text;
}

std::optional<SettlingChange> more_time(const ObjectiveSetting& setting, const Gains<double>& gains,
                                        double share) {
  for (const double factor : {2.0, kMostTime}) {
    const ObjectiveSetting longer = with_times_scaled(setting, factor);
    if (!enough_settle(longer, gains, share)) continue;
    return SettlingChange{
        "/scenarios",
        fmt::format("scenarios of {:g} s in place of {:g} s, with all times in proportion ({})",
                    longer.scenarios.front().duration_s, setting.scenarios.front().duration_s,
                    manoeuvre(longer.scenarios.front()))};
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

/// Name of the change of wider_bounds(), as a key of SettlingSearch::poles().
constexpr const char* kWiderBounds = "bounds";

/// True if at least `share` of the runs settle with one of the sets of gains.
bool any_settles(const ObjectiveSetting& setting, const std::vector<Gains<double>>& gains,
                 double share) {
  return std::ranges::any_of(
      gains, [&](const Gains<double>& one) { return enough_settle(setting, one, share); });
}

}  // namespace

bool has_settled(const ModeScore& run) { return run.metrics.completed && !run.has_failed; }

double settled_share(const ObjectiveSetting& setting, const Gains<double>& gains) {
  const auto all = run_all(setting, draw_noise(setting), std::span(&gains, 1));
  const std::vector<ModeScore>& scores = all.front();
  const auto settled = std::ranges::count_if(scores, has_settled);
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

ObjectiveSetting with_times_scaled(ObjectiveSetting setting, double factor) {
  for (Scenario& scenario : setting.scenarios) {
    scenario.duration_s *= factor;
    for (HeadingStep& step : std::get<HeadingSteps>(scenario.guidance).steps) step.t_s *= factor;
  }
  return setting;
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

const std::vector<Gains<double>>& SettlingSearch::poles(const std::string& change,
                                                        const ConstraintContext& changed,
                                                        const ObserverGains<double>& observer) {
  const auto [known, is_new] = poles_.try_emplace({change, observer.bandwidth_radps});
  if (is_new) {
    for (const Gains<double>& poles : starting_poles(changed, observer)) {
      const Gains<double> gains = change == kWiderBounds ? poles : clamped(poles, bounds_);
      if (meets_constraints(gains, changed)) known->second.push_back(gains);
    }
  }
  return known->second;
}

std::optional<double> SettlingSearch::settling_bandwidth_radps(const ObjectiveSetting& setting,
                                                               const std::string& change,
                                                               const ConstraintContext& changed,
                                                               double share) {
  const AxisForces<double> limits = observer_limits(changed);
  if (!(limits.surge > 0.0)) return std::nullopt;
  for (const double bandwidth_radps : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    if (bandwidth_radps * changed.sample_time_s >= 1.0) break;
    const ObserverGains<double> observer{bandwidth_radps, limits.yaw_m, limits.surge};
    if (any_settles(setting, poles(change, changed, observer), share)) return bandwidth_radps;
  }
  return std::nullopt;
}

std::optional<SettlingChange> SettlingSearch::an_observer(const ObjectiveSetting& setting,
                                                          const Gains<double>& gains,
                                                          double share) {
  if (gains.observer.is_on()) return std::nullopt;
  const auto change = [](double bandwidth_radps, const std::string& more) {
    return SettlingChange{"/observer",
                          fmt::format("{}{} (a disturbance observer; tried with {:g} rad/s)",
                                      option_text("observer"), more, bandwidth_radps)};
  };
  if (const auto bandwidth = settling_bandwidth_radps(setting, {}, context_, share)) {
    return change(*bandwidth, "");
  }
  for (const std::vector<RelaxedLimit>& numbers : relaxed_limits(context_)) {
    for (const RelaxedLimit& limit : numbers) {
      if (!limit.is_steering_rate) continue;
      const std::string text = fmt::format("`{}` {:g}", limit.key, limit.number);
      if (const auto bandwidth = settling_bandwidth_radps(setting, text, limit.context, share)) {
        return change(*bandwidth, " together with " + text);
      }
    }
  }
  return std::nullopt;
}

std::optional<SettlingChange> SettlingSearch::one_mode(const ObjectiveSetting& setting,
                                                       double share) {
  if (context_.mode || !context_.has_steering) return std::nullopt;
  for (const YawMode mode : setting.modes()) {
    ConstraintContext alone = context_;
    alone.mode = mode;
    ObjectiveSetting runs = setting;
    runs.mode = mode;
    const std::string option = option_text("mode " + std::string(name_of(mode)));
    if (!any_settles(runs, poles(option, alone), share)) continue;
    return SettlingChange{"/mode", option + ", gains for this mode only"};
  }
  return std::nullopt;
}

std::optional<SettlingChange> SettlingSearch::wider_bounds(const ObjectiveSetting& setting,
                                                           const Gains<double>& gains,
                                                           double share) {
  for (const Gains<double>& other : poles(kWiderBounds, context_, gains.observer)) {
    std::vector<std::string> texts;
    for (const SearchedGain& gain : kSearchedGains) {
      const std::optional<Interval>& bound = bounds_.*gain.bounds;
      if (!bound || bound->contains(gain.of(other))) continue;
      texts.push_back(fmt::format("`bounds/{}` that contain {:.3g}", gain.key, gain.of(other)));
    }
    if (texts.empty() || !enough_settle(setting, other, share)) continue;
    return SettlingChange{"/bounds", fmt::format("{}", fmt::join(texts, " together with "))};
  }
  return std::nullopt;
}

std::vector<SettlingChange> SettlingSearch::relaxed(const ObjectiveSetting& setting,
                                                    const Gains<double>& gains, double share) {
  std::vector<SettlingChange> changes;
  for (const std::vector<RelaxedLimit>& numbers : relaxed_limits(context_)) {
    for (const RelaxedLimit& limit : numbers) {
      const std::string text = fmt::format("`{}` {:g}", limit.key, limit.number);
      const Gains<double> same = with_friction_width(gains, limit.context);
      const bool settles =
          (meets_constraints(same, limit.context) && enough_settle(setting, same, share)) ||
          any_settles(setting, poles(text, limit.context), share);
      if (!settles) continue;
      changes.push_back({fmt::format("/{}", limit.key), text});
      break;
    }
  }
  return changes;
}

bool SettlingSearch::observer_helps(const ObjectiveSetting& setting, const Gains<double>& gains) {
  if (gains.observer.is_on()) return false;
  for (const Scenario& scenario : setting.scenarios) {
    for (const YawMode mode : setting.modes()) {
      const ObjectiveSetting runs = runs_in(setting, scenario.name, mode);
      const double share = settled_share(runs, gains);
      if (share >= kSettledShare) continue;
      const double more = std::min(kSettledShare, 0.5 * (1.0 + share));
      if (settling_bandwidth_radps(on_few_vehicles(runs), {}, context_, more)) return true;
    }
  }
  return false;
}

std::vector<SettlingChange> scenario_changes(const ObjectiveSetting& setting,
                                             const Gains<double>& gains, double share) {
  std::vector<SettlingChange> changes;
  for (const auto& change :
       {more_time(setting, gains, share), no_rate_limit(setting, gains, share)}) {
    if (change) changes.push_back(*change);
  }
  return changes;
}

std::vector<SettlingChange> SettlingSearch::changes(const ObjectiveSetting& setting,
                                                    const Gains<double>& gains, double share) {
  std::vector<SettlingChange> changes;
  for (const auto& change : {an_observer(setting, gains, share), one_mode(setting, share),
                             wider_bounds(setting, gains, share)}) {
    if (change) changes.push_back(*change);
  }
  std::ranges::copy(relaxed(setting, gains, share), std::back_inserter(changes));
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
      "No change was found that lets {} settle. Tried: four times the duration; no heading-rate "
      "limit; an observer, gains for one mode only, wider bounds and relaxed limits (the last four "
      "with gains by pole placement in place of a search)",
      runs);
}

}  // namespace awmr
