#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/containers.h"
#include "awmr/core/option_text.h"
#include "awmr/tune/goals.h"
#include "awmr/tune/relaxation.h"
#include "awmr/tune/settling.h"
#include "awmr/tune/tuning_steps.h"
#include "awmr/tune/unsettled_text.h"

namespace awmr {
namespace {

/// Error at a place in tune.json; without a place if the options are not from a file.
tl::unexpected<Error> refused_at(const TuneOptions& requested, const std::string& pointer,
                                 ErrorCode code, std::string message) {
  const std::string place = requested.file.empty() ? "" : requested.file + ":" + pointer;
  return tl::unexpected(Error{ErrorKind::kRefused, {{code, place, std::move(message)}}});
}

std::string in_words(const Gains<double>& g) {
  return fmt::format(
      "lambda {:.4g}, mu {:.4g}, epsilon {:.4g}, mu_s {:.4g}, epsilon_s {:.4g}{}", g.heading.lambda,
      g.heading.mu, g.heading.epsilon, g.speed.mu, g.speed.epsilon,
      g.observer.is_on() ? fmt::format(", observer {:.4g} rad/s", g.observer.bandwidth_radps) : "");
}

/// Returns text such as " 32 % of the runs settle with these gains. This change lets the runs
/// settle (...): ...". Empty if enough runs settle.
std::string unsettled_text(const Objective& objective, const ConstraintContext& context,
                           const TuneOptions& requested, const Gains<double>& gains) {
  ObjectiveSetting setting = on_few_vehicles(objective.setting());
  setting.goals.clear();
  const double share = settled_share(setting, gains);
  if (share >= kSettledShare) return {};
  const std::vector<SettlingChange> changes =
      SettlingSearch(context, requested.bounds).changes(setting, gains, kSettledShare);
  return fmt::format(
      " {:.0f} % of the runs settle with these gains. {}.", 100.0 * share,
      changes.empty() ? no_change_settles("the runs") : describe(changes, "the runs"));
}

/// Factor of a limit, rounded up to three digits; infinite if a run never reaches the goal.
double rounded_up(double factor) {
  if (!std::isfinite(factor)) return factor;
  const double digit = std::pow(10.0, std::floor(std::log10(factor)) - 2.0);
  return digit * std::ceil(factor / digit - 1e-9);
}

/// Error that names the goal which the gains nearest to the limits miss most. Empty if these gains
/// meet all goals.
std::optional<tl::unexpected<Error>> goal_missed(const SearchResult& found, const Evaluation& e,
                                                 const Objective& objective,
                                                 const ConstraintContext& context,
                                                 const TuneOptions& requested) {
  const std::vector<GoalInMode> goals = by_mode(objective.goals(), objective.modes());
  std::size_t worst = goals.size();
  for (std::size_t i = 0; i < goals.size(); ++i) {
    if (goals[i].goal->is_soft || e.goal_quantile[i] <= 1.0) continue;
    if (worst == goals.size() || e.goal_quantile[i] > e.goal_quantile[worst]) worst = i;
  }
  if (worst == goals.size()) return std::nullopt;
  const bool is_rate_limited =
      std::ranges::any_of(objective.setting().scenarios,
                          [](const Scenario& one) { return one.name.ends_with(kLedSuffix); });
  return refused_at(
      requested, fmt::format("/goals/{}", goals[worst].goal - objective.goals().data()),
      ErrorCode::kNoGains,
      fmt::format("no gains within the bounds reach the goal \"{}\": of {} evaluated sets, the "
                  "nearest ({}) would need limits {:.4g} times as high.{} In tune.json, set `soft` "
                  "of this goal to true, raise its limits, or increase `local_evaluations`{}",
                  goals[worst].name(), found.evaluations, in_words(found.nearest.gains),
                  rounded_up(e.goal_quantile[worst]),
                  unsettled_text(objective, context, requested, found.nearest.gains),
                  is_rate_limited
                      ? ". One default scenario is slow, because it limits the heading rate "
                        "to the highest measured yaw rate; " +
                            option_text("heading_rate_limit") + " none removes that scenario"
                      : ""));
}

/// Returns the runs of each mode in which the tuned gains never settle in any scenario.
/// Modes that cannot turn the vehicle (UnsettledRuns::why) are left out: no gains let them settle.
std::vector<UnsettledRuns> never_settling(const Tuning& tuning) {
  std::vector<UnsettledRuns> never;
  for (const YawMode mode : kYawModes) {
    std::vector<UnsettledRuns> in_mode;
    std::ranges::copy_if(tuning.unsettled, std::back_inserter(in_mode),
                         [mode](const UnsettledRuns& one) {
                           return one.mode == mode && one.is_never && one.why.empty();
                         });
    const auto scenarios = std::ranges::count(tuning.scores, mode, &ModeScore::mode);
    if (std::ssize(in_mode) == scenarios) append(never, in_mode);
  }
  return never;
}

std::vector<std::string> violated(const std::vector<ConstraintReport>& all) {
  std::vector<std::string> names;
  for (const ConstraintReport& c : all) {
    if (c.required && c.margin < 0.0) names.push_back("'" + c.name + "'");
  }
  return names;
}

}  // namespace

tl::unexpected<Error> infeasible(const Candidate& nearest, const ConstraintContext& context,
                                 const TuneOptions& requested) {
  const std::vector<ConstraintReport> all = constraints_of(nearest.gains, context);
  const auto worst = std::ranges::max_element(
      all, {}, [](const ConstraintReport& c) { return c.required ? residual(c) : -1.0; });
  const std::vector<std::string> changes = single_changes(nearest.gains, context, requested);
  return refused_at(
      requested, pointer_to(worst->name), ErrorCode::kNoGains,
      fmt::format(
          "no gains within the bounds meet the constraints: the nearest gains ({}) violate '{}', "
          "{:.4g} against a limit of {:.4g} ({}). {}",
          in_words(nearest.gains), worst->name, worst->value, worst->limit, worst->meaning,
          changes.empty()
              ? fmt::format("No change of a single limit or bound of tune.json permits "
                            "gains. Violated: {}",
                            fmt::join(violated(all), ", "))
              : fmt::format("{} of tune.json alone permits gains ({}): {}",
                            changes.size() == 1 ? "This change" : "Each of these changes",
                            kSmallerMaySuffice, fmt::join(changes, "; "))));
}

tl::unexpected<Error> not_found(const SearchResult& found, const Objective& objective,
                                const ConstraintContext& context, const TuneOptions& requested) {
  const Evaluation e = objective(found.nearest.gains);
  if (auto missed = goal_missed(found, e, objective, context, requested)) return *missed;
  const std::string gains = in_words(found.nearest.gains);
  if (!e.valid) {
    return refused_at(
        requested, "/scenarios", ErrorCode::kDiverges,
        fmt::format("runs diverge with all {} sets of gains that were tried; the gains nearest to "
                    "the limits are {}. Give slower scenarios or narrower `bounds`",
                    found.evaluations, gains));
  }
  const bool is_activity = found.broken_most.starts_with("activity");
  return refused_at(
      requested, is_activity ? "/activity_max" : pointer_to(found.broken_most), ErrorCode::kNoGains,
      fmt::format("no gains within the bounds meet every limit: the nearest of {} evaluated sets "
                  "of gains ({}) violates '{}' by {:.0f} %; {}, or increase `local_evaluations`",
                  found.evaluations, gains, found.broken_most, 100.0 * found.broken_by,
                  is_activity
                      ? fmt::format("raise activity_max of tune.json to {:.4g}",
                                    rounded_up(*requested.activity_max * (1.0 + found.broken_by)))
                      : advice_on(found.broken_most)));
}

tl::unexpected<Error> never_settles(const Gains<double>& gains, std::size_t runs,
                                    const std::vector<SettlingChange>& changes,
                                    const TuneOptions& requested) {
  return refused_at(
      requested, changes.empty() ? "/scenarios" : changes.front().pointer, ErrorCode::kNoGains,
      fmt::format("no run settles: the search found no gains within the limits with which any of "
                  "the {} runs settles. The gains with the smallest objective are {}. {}",
                  runs, in_words(gains),
                  changes.empty() ? no_change_settles("a run") : describe(changes, "runs")));
}

Status check_settled(const Tuning& tuning, const TuneOptions& requested) {
  if (requested.allows_unsettled) return {};
  std::vector<UnsettledRuns> never = never_settling(tuning);
  for (const Tuning& one : tuning.own) append(never, never_settling(one));
  if (never.empty()) return {};
  Error error{.kind = ErrorKind::kRefused, .faults = {}};
  for (const auto& [text, pointer] : unsettled_texts(never)) {
    const bool has_place = !requested.file.empty() && !pointer.empty();
    error.faults.push_back({ErrorCode::kNoGains, has_place ? requested.file + ":" + pointer : "",
                            fmt::format("{}. Without noise and in {:g} times the duration, no run "
                                        "settles either. To write these gains nevertheless: {}",
                                        text, kMostTime, option_text("allow_unsettled"))});
  }
  return tl::unexpected(std::move(error));
}

}  // namespace awmr
