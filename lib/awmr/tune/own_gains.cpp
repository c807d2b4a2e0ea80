#include <algorithm>
#include <utility>
#include <vector>

#include "awmr/model/gains_json.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/settling.h"
#include "awmr/tune/tuning_context.h"
#include "awmr/tune/tuning_steps.h"

namespace awmr {
namespace {

/// A mode uses its own gains if its objective with them is at most this share of that with the
/// gains for all modes, or if they settle much faster (kMuchFaster).
constexpr double kWorthOwnGains = 0.95;

template <class Results>
void keep_only(YawMode mode, Results& results) {
  std::erase_if(results, [mode](const auto& one) { return one.mode != mode; });
}

/// Returns the results of one mode from a tuning for all modes.
Tuning in_mode(Tuning tuning, YawMode mode) {
  tuning.mode = mode;
  keep_only(mode, tuning.scores);
  keep_only(mode, tuning.baseline_scores);
  keep_only(mode, tuning.held_out_scores);
  keep_only(mode, tuning.certificate->modes);
  keep_only(mode, tuning.unsettled);
  keep_only(mode, tuning.alone);
  if (!tuning.robust) return tuning;
  keep_only(mode, tuning.robust->evaluated);
  keep_only(mode, tuning.robust->evaluated_by_scenario);
  keep_only(mode, tuning.robust->goals);
  return tuning;
}

/// True if the gains `own` are better than `common`: the objective is lower by at least 5 %, or it
/// is not higher and the mean settling time is at most kMuchFaster times as long. At least as many
/// runs must settle, or 95 % of them. `objective`: objective of the runs of one mode.
bool is_better(const Gains<double>& own, const Gains<double>& common, const Objective& objective) {
  const Evaluation of_own = objective(own), of_common = objective(common);
  const bool is_much_faster =
      of_own.trade_off.settling_time_s <= kMuchFaster * of_common.trade_off.settling_time_s;
  const double limit = (is_much_faster ? 1.0 : kWorthOwnGains) * of_common.objective;
  const ObjectiveSetting& runs = objective.setting();
  return of_own.objective <= limit &&
         settled_share(runs, own) >= std::min(kSettledShare, settled_share(runs, common));
}

/// Time of the scenarios in a search for one mode alone, as a share of that in a search for all
/// modes (TuneOptions::has_default_scenarios).
Result<double> time_share(const Model& model, const TuneOptions& options, YawMode mode) {
  if (!options.has_default_scenarios) return 1.0;
  AWMR_ASSIGN_OR_RETURN(const Scenario all, default_tuning_scenario(model));
  AWMR_ASSIGN_OR_RETURN(const Scenario alone, default_tuning_scenario(model, mode));
  return alone.duration_s / all.duration_s;
}

/// Inputs of the searches for one mode alone.
struct ModeSearches {
  const Model& model;
  const TuningProblem& problem;  ///< of the search for all modes
  const TuneOptions& options;
  const Scenario& held_out;
  const Tuning& common;  ///< result of the search for all modes
  /// `options` with an observer, if the gains for all modes have one: without it, a single mode
  /// would not reject constant disturbances.
  TuneOptions observed = options;

  /// The problem of a search for one mode.
  Result<TuningProblem> problem_in(YawMode mode) const {
    TuningProblem of_mode = problem;
    AWMR_ASSIGN_OR_RETURN(const double share, time_share(model, options, mode));
    of_mode.setting = with_times_scaled(std::move(of_mode.setting), share);
    return of_mode;
  }

  /// Tunes for one mode. If runs do not settle with the observer, because it makes the commands
  /// noisier, and an observer was not requested, also tunes without it, and returns the result
  /// without it if the share of settled runs is larger by at least kWorthIt.
  Result<Tuning> search(YawMode mode) const {
    AWMR_ASSIGN_OR_RETURN(const TuningProblem of_mode, problem_in(mode));
    AWMR_ASSIGN_OR_RETURN(const Scenario own_held_out, held_out_scenario(model, mode));
    Result<Tuning> tuning = tune_for(mode, model, of_mode, observed, own_held_out);
    if (options.observer || !observed.observer) return tuning;
    const ObjectiveSetting runs = runs_in(of_mode.setting, {}, mode);
    const double share = tuning ? settled_share(runs, tuning->gains) : 0.0;
    if (share >= kSettledShare) return tuning;
    TuneOptions without = options;
    without.adds_observer = false;
    Result<Tuning> other = tune_for(mode, model, of_mode, without, own_held_out);
    const bool is_worth_it = other && settled_share(runs, other->gains) >= share + kWorthIt;
    return is_worth_it ? std::move(other) : std::move(tuning);
  }

  /// Returns the results for a mode that keeps the gains for all modes, relative to `baseline`.
  Result<Tuning> kept(YawMode mode, const Baseline& baseline) const {
    Tuning tuning = in_mode(common, mode);
    tuning.baseline = baseline;
    evaluate_in(runs_in(problem.setting, {}, mode), tuning);
    if (gains_to_json(baseline.gains.common()) == gains_to_json(common.baseline.gains.common())) {
      return tuning;
    }
    // The trade-off is that of all modes, with the baseline of combined mode.
    std::erase_if(tuning.trade_off.named,
                  [](const NamedTradeOff& one) { return one.gains == "baseline"; });
    AWMR_RETURN_IF_ERROR(compare_with_baseline(tuning));
    return tuning;
  }

 private:
  /// Replaces the objectives and scores of `tuning` (over all modes) by those in the runs of one
  /// mode, relative to Tuning::baseline.
  void evaluate_in(const ObjectiveSetting& runs, Tuning& tuning) const {
    const Objective objective(runs, tuning.baseline.gains.common());
    const Evaluation evaluation = objective(tuning.gains);
    tuning.objective = evaluation.objective;
    tuning.scores = evaluation.scores;
    tuning.baseline_objective = objective.baseline().objective;
    tuning.baseline_scores = objective.baseline().scores;
    const Evaluation elsewhere =
        evaluate_held_out(runs, held_out, tuning.baseline.gains.common(), tuning.gains);
    tuning.held_out_objective = elsewhere.objective;
    tuning.held_out_scores = elsewhere.scores;
  }

  /// Computes again those results for a mode (Tuning::mode) that depend on its baseline: the limits
  /// that it violates, and the runs of newly drawn vehicles.
  Status compare_with_baseline(Tuning& tuning) const {
    auto [setting, context, robust] = problem;
    setting.mode = context.mode = tuning.mode;
    if (robust) limit_steering_rate(context);
    const Gains<double>& baseline = tuning.baseline.gains.common();
    tuning.baseline_violates =
        violated_by_baseline(baseline, Objective(setting, baseline), context, options);
    if (!tuning.robust) return {};
    return evaluate_on_new_vehicles(model, setting, options, tuning);
  }
};

}  // namespace

Result<Tuning> tune_by_mode(const Model& model, const TuningProblem& problem,
                            const TuneOptions& options, const Scenario& held_out, Tuning common) {
  ModeSearches searches{model, problem, options, held_out, common};
  if (common.gains.observer.is_on() && !options.observer) {
    searches.observed.observer.emplace();
    AWMR_RETURN_IF_ERROR(limit_observer(problem.context, searches.observed.observer));
  }
  bool is_any_better = false;
  std::vector<Tuning> all;
  std::vector<ModeCertificate> certified;
  for (const YawMode mode : problem.setting.modes()) {
    Result<Tuning> tuning = searches.search(mode);
    const Baseline baseline = options.baseline ? options.baseline->in(mode) : common.baseline;
    AWMR_ASSIGN_OR_RETURN(const TuningProblem of_mode, searches.problem_in(mode));
    const bool is_used =
        tuning && is_better(tuning->gains, common.gains,
                            Objective(runs_in(of_mode.setting, {}, mode), baseline.gains.common()));
    is_any_better = is_any_better || is_used;
    if (!is_used) tuning = searches.kept(mode, baseline);
    if (!tuning) return tuning;
    if (tuning->gains.observer.is_on()) tuning->observer_added |= common.observer_added;
    certified.push_back(tuning->certificate->modes.front());
    all.push_back(*std::move(tuning));
  }
  if (!is_any_better) return common;
  Tuning tuning = std::move(all.back());  // combined is the last mode
  all.pop_back();
  tuning.certificate->modes = std::move(certified);
  tuning.own = std::move(all);
  return tuning;
}

}  // namespace awmr
