#include "awmr/compare/decision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <variant>

#include "awmr/compare/scoring.h"
#include "awmr/core/containers.h"
#include "awmr/core/parallel.h"
#include "awmr/simulate/batch.h"

namespace awmr {
namespace {

/// Returns the modes of rank 1. If no mode completes a run, there are none.
std::vector<Contender> first_of(const std::vector<RankedMode>& ranking) {
  std::vector<Contender> first;
  for (const RankedMode& mode : ranking) {
    if (mode.rank == 1 && mode.completed_share > 0.0) first.push_back(mode.contender);
  }
  return first;
}

/// Returns the difference in the only ranked metric in which `other` is relevantly worse than
/// `own`. Null if there is no such metric, or more than one.
const PairedDifference* only_gap(const std::vector<PairedDifference>& differences,
                                 const Preferences& preferences, const Contender& own,
                                 const Contender& other) {
  const PairedDifference* only = nullptr;
  for (const PairedDifference& d : differences) {
    if (!d.is_between(own, other) || d.conclusion != Conclusion::kRelevant) continue;
    if (!(weight_of(*d.metric, preferences) > 0.0)) continue;
    if ((*d.mean < 0.0) != (d.first == own)) continue;
    if (only != nullptr) return nullptr;
    only = &d;
  }
  return only;
}

std::optional<NarrowLead> narrow_lead_of(const ScenarioRows& scenario,
                                         const ScenarioStatistics& statistics,
                                         const std::vector<RankedMode>& ranking,
                                         const Preferences& preferences, std::uint64_t seed) {
  const std::vector<Contender> first = first_of(ranking);
  if (first.size() != 1) return std::nullopt;
  std::optional<NarrowLead> lead;
  for (const RankedMode& other : ranking) {
    if (other.contender == first.front()) continue;
    if (contains(other.dominated_by, first.front().label())) continue;
    const PairedDifference* gap =
        only_gap(statistics.differences, preferences, first.front(), other.contender);
    if (gap == nullptr || (lead && lead->metric != gap->metric)) continue;
    const MetricColumn& metric = *gap->metric;
    Preferences halved = preferences;
    halved.weights[std::string(metric.name)] = weight_of(metric, preferences) / kWeightFactor;
    if (!contains(first_of(rank(scenario, statistics, halved, seed)), other.contender)) continue;
    if (!lead) lead = NarrowLead{gap->metric, {}};
    lead->others.push_back(other.contender);
  }
  return lead;
}

/// Returns the weights with which `own` is furthest behind `other`. Each weight w_k may be
/// multiplied or divided by kWeightFactor. Let d_k be the mean loss (log_loss()) of `own` minus
/// that of `other` in metric k, and m = ln(1 + relevance). `own` is behind if
///   sum over k of w_k (d_k - m) > 0.
/// Each term is maximised separately: w_k is multiplied by the factor if d_k > m, else divided.
Preferences worst_weights(const ModeRows& own, const ModeRows& other,
                          const std::vector<ScoredMetric>& scoring,
                          const Preferences& preferences) {
  const double margin = std::log1p(preferences.relevance);
  Preferences worst = preferences;
  for (const ScoredMetric& scored : scoring) {
    const bool is_behind = mean_log_loss(own, scored) - mean_log_loss(other, scored) > margin;
    const double factor = is_behind ? kWeightFactor : 1.0 / kWeightFactor;
    worst.weights[std::string(scored.metric->name)] =
        factor * weight_of(*scored.metric, preferences);
  }
  return worst;
}

/// Finds the contenders (modes with their gains) that have rank 1 with all weights between
/// 1/kWeightFactor and kWeightFactor times the given weights.
Change change_of_weights(const ScenarioRows& scenario, const ScenarioStatistics& statistics,
                         const Preferences& preferences, std::uint64_t seed) {
  const std::vector<ScoredMetric> scoring = scoring_of(scenario, preferences);
  Change change{.scenario = scenario.scenario,
                .kind = ChangeKind::kWeights,
                .setting = fmt::format("within a factor {:g}", kWeightFactor),
                .first = {}};
  for (const ModeRows& own : scenario.modes) {
    const bool stays =
        std::all_of(scenario.modes.begin(), scenario.modes.end(), [&](const ModeRows& other) {
          if (&other == &own) return true;
          const Preferences worst = worst_weights(own, other, scoring, preferences);
          return contains(first_of(rank(scenario, statistics, worst, seed)), own.contender);
        });
    if (stays) change.first.push_back(own.contender);
  }
  return change;
}

/// Stores the modes of rank 1 and the numbers of completed runs in `change`.
void evaluate(const std::vector<ComparisonRow>& rows, const CompareOptions& options,
              Change& change) {
  const Comparison comparison{.rows = rows};
  const ScenarioRows scenario = group(comparison).front();
  const auto statistics = statistics_of(scenario, options.preferences, options.seed);
  change.first = first_of(rank(scenario, statistics, options.preferences, options.seed));
  for (const ModeRows& mode : scenario.modes) {
    change.completed.push_back({mode.contender, mode.completed_count(), mode.counted().size()});
  }
}

/// Multiplies the bandwidths of both closed loops by a factor. They follow from the gains: lambda
/// and mu/epsilon for the heading loop, mu_s/epsilon_s for the speed loop.
NamedGains with_rates_times(double factor, const NamedGains& set) {
  const auto changed = [factor](Gains<double> gains) {
    gains.heading.lambda *= factor;
    gains.heading.mu *= factor;
    gains.speed.mu *= factor;
    return gains;
  };
  ModeGains all(changed(set.gains.common()));
  for (const YawMode mode : kYawModes) {
    if (set.gains.has_own(mode)) all.set(mode, changed(set.gains.in(mode)));
  }
  return {set.name, all};
}

std::string message_of(const Error& error) {
  const Fault& fault = error.faults.front();
  return fault.place.empty() ? fault.message : fmt::format("{}: {}", fault.place, fault.message);
}

PlantKind other_plant(const Scenario& scenario) {
  return scenario.tyres ? PlantKind::kModel : PlantKind::kFourWheel;
}

/// Errors (input): a key of the scenario has no meaning on the other plant.
Result<Scenario> on_other_plant(Scenario scenario, const Tyres<double>& tyres) {
  if (scenario.tyres) {
    scenario.tyres.reset();
    return scenario;
  }
  for (const TyreConflict& conflict : tyre_conflicts(scenario)) {
    return input_error(ErrorCode::kConflict, "/" + conflict.key, conflict.message);
  }
  scenario.tyres = tyres;
  return scenario;
}

/// A scenario to be simulated with a changed plant or changed gains, and its result.
struct ChangedScenario {
  Change change;
  Scenario scenario;
  std::vector<NamedGains> gains;
};

/// Returns one entry for each scenario and change of plant or gains that can be run, in the order
/// of `scenarios`. Changes that cannot be run are added to `changes` with the reason.
std::vector<ChangedScenario> changed_scenarios(const std::vector<NamedGains>& gains,
                                               const std::vector<Scenario>& scenarios,
                                               const Tyres<double>& tyres,
                                               std::vector<Change>& changes) {
  std::vector<ChangedScenario> changed;
  for (const Scenario& scenario : scenarios) {
    // An open-loop scenario has no ranking.
    if (std::holds_alternative<OpenLoop>(scenario.guidance)) continue;
    Change change{.scenario = scenario.name,
                  .kind = ChangeKind::kPlant,
                  .setting = std::string(name_in(kPlantKindNames, other_plant(scenario))),
                  .first = {}};
    if (auto other = on_other_plant(scenario, tyres)) {
      changed.push_back({std::move(change), *std::move(other), gains});
    } else {
      change.not_run = message_of(other.error());
      changes.push_back(std::move(change));
    }
    // Several sets of gains are compared with each other, so they are not varied.
    if (gains.size() > 1) continue;
    for (const auto& [setting, factor] :
         {std::pair("slower", 1.0 / kGainsFactor), std::pair("faster", kGainsFactor)}) {
      changed.push_back(
          {{.scenario = scenario.name, .kind = ChangeKind::kGains, .setting = setting, .first = {}},
           scenario,
           {with_rates_times(factor, gains.front())}});
    }
  }
  return changed;
}

}  // namespace

std::vector<Contender> Decision::never_behind() const {
  std::vector<Contender> left;
  std::copy_if(first.begin(), first.end(), std::back_inserter(left), [&](const Contender& one) {
    return std::all_of(changes.begin(), changes.end(),
                       [&](const Change& change) { return contains(change.first, one); });
  });
  return left;
}

DecisionKind Decision::kind() const {
  const std::size_t count = never_behind().size();
  if (count == 0 || narrow_lead) return DecisionKind::kUndecided;
  return count == 1 ? DecisionKind::kDecided : DecisionKind::kLevel;
}

bool Decision::survives(const Change& change) const {
  return std::any_of(first.begin(), first.end(),
                     [&](const Contender& one) { return contains(change.first, one); });
}

/// The trials are those in which the plants differ: on four wheels, tyres scrub in differential
/// turns, and steer without thrust while the vehicle coasts.
std::vector<std::string_view> Decision::deciding_trials() const {
  bool differential = false;
  bool steered = false;
  for (const Change& change : changes) {
    if (change.kind != ChangeKind::kPlant) continue;
    for (const auto* some : {&first, &change.first}) {
      const auto& others = some == &first ? change.first : first;
      for (const Contender& one : *some) {
        if (contains(others, one)) continue;
        differential = differential || one.mode != YawMode::kSteering;
        steered = steered || one.mode != YawMode::kDifferential;
      }
    }
  }
  std::vector<std::string_view> trials;
  if (differential) trials.push_back(kDifferentialTurns);
  if (steered) trials.push_back(kSteerWhileCoasting);
  return trials;
}

std::vector<Change> changes_of_runs(const Model& model, const std::vector<NamedGains>& gains,
                                    const std::vector<Scenario>& scenarios,
                                    const CompareOptions& options) {
  std::vector<Change> changes;
  if (gains.size() * yaw_modes(model.vehicle).size() < 2) return changes;  // nothing to rank
  std::vector<ChangedScenario> changed =
      changed_scenarios(gains, scenarios, options.tyres, changes);
  // Each change is one batch on one thread; the changes are distributed over the threads.
  CompareOptions few;
  few.samples = std::min(options.samples, static_cast<int>(kBatchRuns) - 1);
  few.seed = options.seed;
  few.preferences = options.preferences;
  few.threads = 1;
  few.stop = options.stop;
  parallel_for(changed.size(), options.threads, [&](std::size_t i) {
    ChangedScenario& one = changed[i];
    const auto comparison = compare(model, one.gains, {one.scenario}, few);
    if (!comparison) {
      one.change.not_run = message_of(comparison.error());
    } else if (!comparison->stopped) {
      evaluate(comparison->rows, few, one.change);
    }
  });
  for (ChangedScenario& one : changed) changes.push_back(std::move(one.change));
  return changes;
}

Decision decide(const ScenarioRows& scenario, const ScenarioStatistics& statistics,
                const std::vector<RankedMode>& ranking, const std::vector<Change>& changes,
                const Preferences& preferences, std::uint64_t seed) {
  Decision decision{first_of(ranking), {}};
  decision.narrow_lead = narrow_lead_of(scenario, statistics, ranking, preferences, seed);
  decision.changes.push_back(change_of_weights(scenario, statistics, preferences, seed));
  std::copy_if(changes.begin(), changes.end(), std::back_inserter(decision.changes),
               [&](const Change& change) {
                 return change.scenario == scenario.scenario && change.not_run.empty();
               });
  return decision;
}

}  // namespace awmr
