#include "awmr/compare/break_even.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "awmr/compare/ranking.h"
#include "awmr/compare/scoring.h"
#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/parallel.h"
#include "awmr/core/units.h"
#include "awmr/model/fitted_law.h"
#include "awmr/model/tyres.h"
#include "awmr/simulate/batch.h"

namespace awmr {
namespace {

/// Smallest scrub moment of the search, as a fraction of the largest moment. The search starts with
/// small moments and increases them tenfold, because runs with a larger moment need shorter
/// integration steps, and may not be needed at all.
constexpr double kMin = 1e-4;

/// Inputs of the break-even analysis for one scenario on the nominal model and one mode.
struct ModeSetting {
  const Scenario* scenario;
  YawMode mode;
  Plant<double> plant;
  std::map<YawMode, Controller<double>> controllers;
  double sample_time_s;
  BatchArithmetic arithmetic;
};

/// Simulates the scenario in `mode`, once with each scrub moment of the tyres. Returns the metrics
/// in the order of the moments; absent for a failed simulation.
std::vector<std::optional<Metrics>> driven_with(const ModeSetting& setting, YawMode mode,
                                                const std::vector<double>& moments_m) {
  std::vector<BatchRun> runs;
  for (const double moment_m : moments_m) {
    Plant<double> plant = setting.plant;
    plant.yaw_scrub_m = moment_m;
    runs.push_back({plant, setting.controllers.at(mode), mode, 0, 0});
  }
  std::vector<std::optional<Metrics>> driven;
  for (const DrivenRun& one :
       simulate_batch(runs, *setting.scenario, setting.sample_time_s, setting.arithmetic)) {
    driven.push_back(one.run.end == RunEnd::kFailed ? std::nullopt : std::optional(one.metrics));
  }
  return driven;
}

/// True if mode A is ahead of mode B if both have the same scrub. `run`, `other`: metrics of A and
/// B with this scrub; absent if the simulation failed. `without`: metrics of A without scrub. A is
/// ahead if its score is at least as good, or if only the simulation of B failed. A is not ahead if
/// its own simulation failed, or if scrub keeps A from completing the scenario or from having a
/// scored metric, such as the settling time.
bool is_ahead(const std::optional<Metrics>& run, const Metrics& without,
              const std::optional<Metrics>& other, const std::vector<ScoredMetric>& scoring) {
  if (!run || (without.completed && !run->completed)) return false;
  if (!other) return true;
  const bool lost = std::any_of(scoring.begin(), scoring.end(), [&](const ScoredMetric& scored) {
    return scored.metric->value(without) && !scored.metric->value(*run);
  });
  return !lost && log_score(*run, scoring) <= log_score(*other, scoring);
}

/// kBatchRuns equidistant values from `lo` to `hi`, both included.
std::vector<double> evenly_between(double lo, double hi) {
  std::vector<double> values;
  for (std::size_t i = 0; i < kBatchRuns; ++i) {
    values.push_back(lo + (hi - lo) * static_cast<double>(i) / (kBatchRuns - 1));
  }
  return values;
}
/// kBatchRuns values from `lo` to `hi`, each the same factor larger than the one before.
std::vector<double> in_ratios_between(double lo, double hi) {
  std::vector<double> values = evenly_between(std::log(lo), std::log(hi));
  std::transform(values.begin(), values.end(), values.begin(),
                 [](double value) { return std::exp(value); });
  return values;
}

std::optional<std::size_t> first_false(const std::vector<bool>& all) {
  const auto found = std::find(all.begin(), all.end(), false);
  if (found == all.end()) return std::nullopt;
  return at(found - all.begin());
}

/// Returns the smallest scrub moment at which a mode is no longer ahead, with an error of at most 1
/// %. Absent if the mode is ahead up to `most_m`. `ahead` computes for a list of moments whether
/// the mode is ahead at each.
template <class Ahead>
std::optional<double> least_that_ends(double most_m, const Ahead& ahead) {
  constexpr double kFine = 0.01;
  constexpr int kMaxRounds = 3;
  for (double share = kMin; share < 0.99; share *= 10.0) {
    const std::vector<double> decade_m = in_ratios_between(share * most_m, 10.0 * share * most_m);
    const auto first = first_false(ahead(decade_m));
    if (!first) continue;
    double kept_m = *first > 0 ? decade_m[*first - 1] : 0.0;
    double ended_m = decade_m[*first];
    for (int rounds = 0; rounds < kMaxRounds && ended_m - kept_m > kFine * ended_m; ++rounds) {
      const std::vector<double> between_m = evenly_between(kept_m, ended_m);
      const std::size_t end = first_false(ahead(between_m)).value_or(between_m.size() - 1);
      kept_m = end > 0 ? between_m[end - 1] : 0.0;
      ended_m = between_m[end];
    }
    return ended_m;
  }
  return std::nullopt;
}

/// Returns the runs of the nominal model (sample 0) without tyre scrub. Simulates them again only
/// if the model has scrub.
Result<std::vector<ComparisonRow>> rows_without_scrub(const Model& model, const ModeGains& gains,
                                                      const std::vector<Scenario>& scenarios,
                                                      const Comparison& comparison, int threads) {
  if (model.yaw_scrub) {
    Model bare = model;
    bare.yaw_scrub.reset();
    AWMR_ASSIGN_OR_RETURN(Comparison again, compare(bare, gains, scenarios, {.threads = threads}));
    return std::move(again.rows);
  }
  std::vector<ComparisonRow> rows;
  std::copy_if(comparison.rows.begin(), comparison.rows.end(), std::back_inserter(rows),
               [](const ComparisonRow& row) { return row.sample == 0; });
  return rows;
}

/// Selects the rows of one scenario, as needed by scoring_of().
ScenarioRows nominal_rows(const std::vector<ComparisonRow>& all, const std::string& scenario) {
  ScenarioRows rows{scenario, {}};
  for (const ComparisonRow& row : all) {
    if (row.scenario == scenario) rows.modes.push_back({{row.mode, ""}, {&row, 1}});
  }
  return rows;
}

/// One pair of modes whose break-even scrub is computed: the inputs, and the result `entry`.
struct Question {
  ModeSetting setting;
  std::vector<ScoredMetric> scoring;
  Metrics own;  ///< metrics of the run of `setting.mode` without scrub
  BreakEven entry;
};

/// Returns a Question for each mode of which `setting.mode` is ahead: the other mode has smaller
/// wheel-force differences and a worse score. A mode is left out if it completes the scenario and
/// `setting.mode` does not. `rows`: the rows of sample 0, the nominal model.
std::vector<Question> questions_of(const ModeSetting& setting, const ScenarioRows& rows,
                                   const std::vector<ScoredMetric>& scoring, BreakEven entry) {
  std::vector<Question> questions;
  const auto row_of = [&](YawMode mode) {
    return std::find_if(rows.modes.begin(), rows.modes.end(),
                        [&](const ModeRows& one) { return one.contender.mode == mode; });
  };
  const Metrics& own = row_of(setting.mode)->nominal();
  for (const YawMode less : {YawMode::kCombined, YawMode::kSteering}) {
    const auto other = row_of(less);
    if (less == setting.mode || other == rows.modes.end()) continue;
    if (other->nominal().completed > own.completed) continue;
    if (!(log_score(own, scoring) < log_score(other->nominal(), scoring))) continue;
    entry.scenario = rows.scenario;
    entry.mode = setting.mode;
    entry.against = less;
    questions.push_back({setting, scoring, own, entry});
  }
  return questions;
}

void answer(Question& question) {
  question.entry.yaw_coulomb_m =
      least_that_ends(question.entry.most_m, [&](const std::vector<double>& moments_m) {
        const auto own = driven_with(question.setting, question.entry.mode, moments_m);
        const auto other = driven_with(question.setting, question.entry.against, moments_m);
        std::vector<bool> ahead;
        for (std::size_t i = 0; i < own.size(); ++i) {
          ahead.push_back(is_ahead(own[i], question.own, other[i], question.scoring));
        }
        return ahead;
      });
}

/// Adds to `entry` the scrub that was measured in differential turns. If the result is undecided
/// and further turns could decide it, also adds the total number of turns needed. Precondition: all
/// other fields of `entry` are set.
void add_measured(const Model& model, BreakEven& entry) {
  const auto& scrub = model.yaw_scrub;
  if (scrub) {
    entry.measured_m = scrub->ci95_m;
    if (const auto& changing = scrub->changing_m) {
      entry.measured_m = Interval{std::min(scrub->ci95_m.lo, changing->lo),
                                  std::max(scrub->ci95_m.hi, changing->hi)};
    }
    entry.measured_degps =
        Interval{degrees(scrub->yaw_rate_radps.lo), degrees(scrub->yaw_rate_radps.hi)};
  }
  if (const auto& held_m = model.yaw_held_m) {
    if (!entry.measured_m) entry.measured_m = Interval{*held_m, std::max(*held_m, entry.most_m)};
    entry.measured_m->hi = std::max(entry.measured_m->hi, *held_m);
  }
  if (!scrub || !entry.yaw_coulomb_m || scrub->changing_m || turns_at_other_rates(entry) ||
      lead_of(entry) != Lead::kOpen || !scrub->ci95_m.contains(*entry.yaw_coulomb_m)) {
    return;
  }
  // The half width of the measured interval is proportional to 1/sqrt(n) for n turns. n turns
  // suffice if the interval does not contain the break-even scrub.
  constexpr double kMaxTurns = 1000.0;
  const double half = 0.5 * (scrub->ci95_m.hi - scrub->ci95_m.lo);
  const double shrunk = half / std::abs(*entry.yaw_coulomb_m - scrub->moment_m);
  const double turns = std::ceil(scrub->rows * shrunk * shrunk);
  if (turns <= kMaxTurns) entry.turns_to_decide = static_cast<int>(turns);
}

/// Returns the pairs of modes to examine, in all scenarios. `without`: the runs of the nominal
/// model (sample 0) without scrub. `entry`: initial value of each pair's result, with most_m and
/// sliding_m, which are the same for all pairs.
Result<std::vector<Question>> all_questions(const Model& model, const ModeGains& gains,
                                            const std::vector<Scenario>& scenarios,
                                            const std::vector<ComparisonRow>& without,
                                            const Preferences& preferences,
                                            const BreakEven& entry) {
  AWMR_ASSIGN_OR_RETURN(const BatchArithmetic arithmetic, batch_arithmetic());
  AWMR_ASSIGN_OR_RETURN(const Plant<double> nominal, model.plant());
  std::map<YawMode, Controller<double>> controllers;
  for (const YawMode mode : kYawModes) {
    controllers.emplace(mode, make_controller(nominal, model.vehicle, gains.in(mode)));
  }
  std::vector<Question> questions;
  for (const Scenario& scenario : scenarios) {
    AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, plant_for(scenario, model));
    const ScenarioRows rows = nominal_rows(without, scenario.name);
    const std::vector<ScoredMetric> scoring = scoring_of(rows, preferences);
    if (!has_a_goal(rows) || scoring.empty()) continue;
    for (const ModeRows& one : rows.modes) {
      if (one.contender.mode == YawMode::kSteering) continue;
      const ModeSetting setting{&scenario,   one.contender.mode,          plant,
                                controllers, model.vehicle.sample_time_s, arithmetic};
      std::ranges::move(questions_of(setting, rows, scoring, entry), std::back_inserter(questions));
    }
  }
  return questions;
}

}  // namespace

Result<std::vector<BreakEven>> break_even_of(const Model& model, const ModeGains& gains,
                                             const std::vector<Scenario>& scenarios,
                                             const Comparison& comparison,
                                             const CompareOptions& options) {
  if (model.yaw_by_sides_alone) {
    return input_error(
        ErrorCode::kNotIdentified, option_text("break_even"),
        "yaw resistance was identified from differential turns and already includes their scrub; "
        "add steered turns (steering_deg, wheel_force) to the turning table and identify again");
  }
  AWMR_ASSIGN_OR_RETURN(const Plant<double> nominal, model.plant());
  const Interval force = model.vehicle.wheel_force;
  BreakEven entry;
  // Largest yaw moment of the wheel forces: 2 d (F'R - F'L) with F'R = F'max and F'L = F'min.
  entry.most_m = 2.0 * nominal.half_track_m * (force.hi - force.lo);
  entry.sliding_m = sliding_moment_m(nominal);
  AWMR_ASSIGN_OR_RETURN(const std::vector<ComparisonRow> without,
                        rows_without_scrub(model, gains, scenarios, comparison, options.threads));
  AWMR_ASSIGN_OR_RETURN(
      std::vector<Question> questions,
      all_questions(model, gains, scenarios, without, options.preferences, entry));
  parallel_for(questions.size(), options.threads, [&](std::size_t i) { answer(questions[i]); });
  std::vector<BreakEven> answers;
  for (Question& question : questions) {
    question.entry.fastest_degps = question.own.yaw_rate_max_degps;
    add_measured(model, question.entry);
    answers.push_back(std::move(question.entry));
  }
  return answers;
}

bool turns_at_other_rates(const BreakEven& entry) {
  return entry.measured_degps && (entry.fastest_degps > kLittleFurther * entry.measured_degps->hi ||
                                  kLittleFurther * entry.fastest_degps < entry.measured_degps->lo);
}

std::optional<Lead> lead_of(const BreakEven& entry) {
  if (!entry.measured_m) return std::nullopt;
  if (!entry.yaw_coulomb_m) return Lead::kKept;
  if (turns_at_other_rates(entry)) return Lead::kOpen;
  if (entry.measured_m->hi < *entry.yaw_coulomb_m) return Lead::kKept;
  return entry.measured_m->lo > *entry.yaw_coulomb_m ? Lead::kLost : Lead::kOpen;
}

}  // namespace awmr
