#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/parallel.h"
#include "awmr/tune/certificate.h"
#include "awmr/tune/feasible_gains.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/pole_placement.h"
#include "awmr/tune/problem.h"
#include "awmr/tune/search.h"
#include "awmr/tune/settling.h"
#include "awmr/tune/tuning_context.h"
#include "awmr/tune/tuning_steps.h"
#include "awmr/tune/unsettled_cause.h"

namespace awmr {
namespace {

/// Returns the setting of the search: the nominal vehicle and the first of the drawn vehicles.
ObjectiveSetting searched(ObjectiveSetting setting, const TuneOptions& options) {
  const std::size_t as_many_runs =
      at(kSearchedDraws) * std::size(kYawModes) / setting.modes().size();
  const std::size_t draws = std::max(as_many_runs, options.open.combinations());
  if (setting.vehicles.size() > 1 + draws) setting.vehicles.resize(1 + draws);
  return setting;
}

Status check_baseline(const Objective& objective, const Baseline& baseline) {
  if (objective.baseline().valid) return {};
  return input_error(ErrorCode::kDiverges, baseline.source,
                     "runs with the baseline gains diverge, so the objective cannot be normalised; "
                     "give another baseline, or slower scenarios");
}

/// Factors of slowed() for further starts of the search. If the sensor noise is large, only slower
/// poles meet the limits on noise.
constexpr double kSlowerStarts[] = {0.7, 0.5, 0.35, 0.25};

/// Bandwidths of the observer from which the search starts, rad/s.
constexpr double kStartBandwidths[] = {0.25, 0.5, 1.0, 2.0};

/// Returns the gains from which the search starts:
///   - `first`, which meets the constraints;
///   - the second of `poles`;
///   - the first of `poles`, slowed down by each of kSlowerStarts;
///   - if an observer is searched, gains by pole placement with each of kStartBandwidths;
///   - the baseline, if it is given.
/// Gains that violate a constraint are replaced by gains near them that meet the constraints
/// (feasible_gains()), or left out if there are none.
std::vector<Gains<double>> starts_of(const TuneOptions& options, const ConstraintContext& context,
                                     const Gains<double>& first,
                                     std::span<const Gains<double>> poles,
                                     const Baseline& baseline) {
  std::vector<std::function<Gains<double>()>> proposed;
  for (const Gains<double>& other : poles.subspan(1)) proposed.push_back([other] { return other; });
  for (const double share : kSlowerStarts) {
    proposed.push_back([&, share] { return slowed(poles.front(), share); });
  }
  const auto& observer = options.observer;
  for (const double bandwidth_radps : kStartBandwidths) {
    if (!observer || !observer->bandwidth_radps.contains(bandwidth_radps)) continue;
    proposed.push_back([&, bandwidth_radps] {
      return starting_poles(context,
                            {bandwidth_radps, *observer->yaw_max_m, *observer->surge_max})[0];
    });
  }
  if (options.baseline) proposed.push_back([&] { return baseline.gains.common(); });
  std::vector<Candidate> near(proposed.size());
  parallel_for(proposed.size(), 0, [&](std::size_t i) {
    near[i] = feasible_gains(options, context, proposed[i](), 1);
  });
  std::vector<Gains<double>> starts{first};
  for (const Candidate& one : near) {
    if (!(one.violation > 0.0)) starts.push_back(one.gains);
  }
  return starts;
}

/// Repeats the search with an observer. `gains`: the result without observer or, if no gains meet
/// the limits, those nearest to the limits. The result is empty
///   - if no observer may be added (TuneOptions::adds_observer);
///   - if enough runs settle, or sensor noise keeps some of them from settling (noise_effect());
///   - if simulations do not show that an observer lets more runs settle (SettlingSearch);
///   - if the share of settled runs increases by less than kWorthIt.
std::optional<Tuning> with_needed_observer(const Model& model, const ObjectiveSetting& setting,
                                           const ConstraintContext& context,
                                           const TuneOptions& requested, const Scenario& held_out,
                                           const Gains<double>& gains) {
  const bool has_observer =
      requested.observer || std::ranges::any_of(setting.scenarios, [](const Scenario& scenario) {
        return scenario.control.observer.has_value();
      });
  if (has_observer || !requested.adds_observer) return std::nullopt;
  const double share = settled_share(setting, gains);
  if (share >= kSettledShare || (share > 0.0 && noise_effect(setting, gains)) ||
      !SettlingSearch(context, requested.bounds).observer_helps(setting, gains)) {
    return std::nullopt;
  }
  TuneOptions options = requested;
  options.observer.emplace();
  if (!limit_observer(context, options.observer)) return std::nullopt;
  if (options.notice) {
    options.notice(
        "some runs settle only with a disturbance observer, so the search is repeated with an "
        "observer, which takes about as long again");
  }
  Result<Tuning> observed = search_gains(model, setting, context, options, held_out);
  if (!observed || settled_share(setting, observed->gains) < share + kWorthIt) {
    if (options.notice) {
      options.notice("hardly more runs settle with the observer, so it is not used");
    }
    return std::nullopt;
  }
  observed->observer_added = true;
  return *std::move(observed);
}

/// Settings and result of one search.
struct Searched {
  const Model& model;
  const ObjectiveSetting& setting;
  const ConstraintContext& context;
  const TuneOptions& options;
  /// The options as the user gave them; in `options`, absent bounds are filled in.
  const TuneOptions& requested;
  const Baseline& baseline;
  const Gains<double>& poles;  ///< by pole placement for all modes, without observer
  const Objective& all;        ///< on all draws
  const Objective& some;       ///< on the draws of the search
  const SearchResult& found;
  const SettledGains& settled;
};

/// Error (refused) if no run settles with the tuned gains, not even without sensor noise. `scores`:
/// runs of the nominal vehicle. Usually one of these runs settles, so nothing else is simulated.
Status check_settling(const Searched& s, const std::vector<ModeScore>& scores) {
  if (s.options.allows_unsettled || std::ranges::any_of(scores, has_settled)) return {};
  const Gains<double>& gains = s.settled.gains;
  if (settled_share(s.setting, gains) > 0.0 ||
      settled_share_without_noise(s.setting, gains) > 0.0) {
    return {};
  }
  ObjectiveSetting few = on_few_vehicles(s.setting);
  few.goals.clear();
  constexpr double kAny = 1e-9;
  std::vector<SettlingChange> changes = scenario_changes(few, gains, kAny);
  std::ranges::move(SettlingSearch(s.context, s.requested.bounds).changes(few, gains, kAny),
                    std::back_inserter(changes));
  const std::size_t runs =
      s.setting.vehicles.size() * s.setting.modes().size() * s.setting.scenarios.size();
  return never_settles(gains, runs, changes, s.options);
}

/// Modes in which gains for this mode alone can be better than the tuned gains.
struct ModesAlone {
  std::vector<ModeAlone> faster;  ///< Tuning::alone
  bool is_any_better = false;     ///< Tuning::is_mode_better_alone
};

/// Tries two kinds of gains for each mode alone, in the runs of this mode:
///   - gains by pole placement with wide boundary layers, which give most vehicles a smaller
///     objective;
///   - the tuned gains, made faster by the square root and the fourth root of a ratio: lambda by
///     pole placement for this mode, divided by lambda by pole placement for all modes. These gains
///     need not meet the constraints, because the search for one mode ensures that.
/// Gains outside of the bounds that the user gave are moved to the bounds.
/// With an observer, all modes have the friction width of the steering, which is wide if the
/// compass is noisy. With a width of its own, a mode corrects dry friction without waiting for the
/// observer, so gains for each mode alone can then be better in any case.
ModesAlone modes_alone(const Searched& s) {
  constexpr double kBetter = 0.97;  // of the objective
  ModesAlone found;
  if (s.setting.modes().size() < 2) return found;
  const Gains<double>& tuned = s.settled.gains;
  found.is_any_better = tuned.observer.is_on() &&
                        tuned.heading.friction_width_radps > feed_forward_rest_speed<double>();
  const GainBounds& bounds = s.requested.bounds;
  const Gains<double> common_poles = clamped(
      tuned.observer.is_on() ? starting_poles(s.context, tuned.observer).front() : s.poles, bounds);
  for (const YawMode mode : s.setting.modes()) {
    ConstraintContext context = s.context;
    context.mode = mode;
    const Objective objective(on_few_vehicles(runs_in(s.setting, {}, mode)),
                              s.baseline.gains.common());
    const Evaluation of_tuned = objective(tuned);
    const Gains<double> poles = clamped(starting_poles(context, tuned.observer).front(), bounds);
    const Evaluation of_poles = objective(poles);
    const double tuned_s = of_tuned.trade_off.settling_time_s;
    const double poles_s = of_poles.trade_off.settling_time_s;
    if (meets_constraints(poles, context) && of_poles.valid &&
        of_poles.objective < of_tuned.objective && poles_s < kMuchFaster * tuned_s) {
      found.faster.push_back(
          {.mode = mode, .settling_time_s = poles_s, .tuned_settling_time_s = tuned_s});
    }
    const double ratio = poles.heading.lambda / common_poles.heading.lambda;
    for (const double factor : {std::sqrt(ratio), std::sqrt(std::sqrt(ratio))}) {
      const Gains<double> faster = clamped(slowed(tuned, factor), bounds);
      const bool is_better =
          ratio > 1.0 && objective(faster).objective < kBetter * of_tuned.objective;
      found.is_any_better = found.is_any_better || is_better;
    }
  }
  return found;
}

/// Returns the result of tune() for the gains that the search selected. Errors (refused): no run
/// settles.
Result<Tuning> tuning_of(const Searched& s, const Scenario& held_out) {
  const auto& [model, setting, context, options, requested, baseline, poles, all, some, found,
               settled] = s;
  AWMR_ASSIGN_OR_RETURN(std::vector<ActiveConstraint> active,
                        active_constraints(options, context, some, found.nearest));
  const Evaluation tuned = all(settled.gains);
  AWMR_RETURN_IF_ERROR(check_settling(s, tuned.scores));
  AWMR_ASSIGN_OR_RETURN(Certificate certificate,
                        certify(model, context, options.open, settled.gains, tuned.scores));
  const Evaluation evaluated =
      evaluate_held_out(setting, held_out, baseline.gains.common(), settled.gains);
  ModesAlone alone = modes_alone(s);
  return Tuning{
      .gains = settled.gains,
      .constraints = constraints_of(settled.gains, context),
      .objective = tuned.objective,
      .scores = tuned.scores,
      .baseline = baseline,
      .limits = context.limits,
      .examined = {context.speed_mps, context.step_rad, context.fastest_radps},
      .baseline_objective = all.baseline().objective,
      .baseline_scores = all.baseline().scores,
      .baseline_violates = violated_by_baseline(baseline.gains.common(), all, context, requested),
      .algorithm = found.algorithm,
      .evaluations = found.evaluations,
      .stop_reason = found.stop_reason,
      .seed = options.seed,
      .simulated = found.simulated,
      .mu_as_good = settled.mu,
      .speed_mu_as_good = settled.speed_mu,
      .active = std::move(active),
      .arithmetic = std::string(setting.arithmetic.rounding),
      .history = found.history,
      .held_out_scores = evaluated.scores,
      .held_out_objective = evaluated.objective,
      .certificate = std::move(certificate),
      .trade_off = trade_off_of(some, context, found.met, settled.gains, baseline.gains.common()),
      .observer_added = false,
      .unsettled = {},
      .alone = std::move(alone.faster),
      .is_mode_better_alone = alone.is_any_better,
      .robust = {}};
}

}  // namespace

Evaluation evaluate_held_out(ObjectiveSetting setting, const Scenario& held_out,
                             const Gains<double>& baseline, const Gains<double>& gains) {
  setting.scenarios = {held_out};
  setting.goals.clear();
  return Objective(std::move(setting), baseline)(gains);
}

Result<Tuning> search_gains(const Model& model, const ObjectiveSetting& setting,
                            const ConstraintContext& context, const TuneOptions& requested,
                            const Scenario& held_out) {
  const std::array<Gains<double>, 2> poles = starting_poles(context);
  TuneOptions options = requested;
  bound_around(poles, options.bounds);
  const Candidate first = feasible_gains(options, context, poles[0]);
  if (first.violation > 0.0) return infeasible(first, context, requested);
  const Baseline baseline =
      options.baseline ? options.baseline->in(options.mode) : Baseline{poles[1], kPolePlacement};
  const std::vector<Gains<double>> starts =
      starts_of(options, context, first.gains, poles, baseline);
  const Objective all(setting, baseline.gains.common());
  AWMR_RETURN_IF_ERROR(check_baseline(all, baseline));
  const Objective some(searched(setting, options), baseline.gains.common());
  AWMR_ASSIGN_OR_RETURN(const SearchResult found, search(options, context, some, all, starts));
  const SettledGains settled = found.nearest.feasible()
                                   ? settle(options, context, some, all, found.nearest)
                                   : SettledGains{found.nearest.gains, {}, {}};
  if (auto observed =
          with_needed_observer(model, setting, context, requested, held_out, settled.gains)) {
    return *std::move(observed);
  }
  if (!found.nearest.feasible()) return not_found(found, all, context, requested);
  return tuning_of(
      {model, setting, context, options, requested, baseline, poles[0], all, some, found, settled},
      held_out);
}

}  // namespace awmr
