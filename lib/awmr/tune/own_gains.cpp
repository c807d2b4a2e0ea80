#include <algorithm>
#include <utility>
#include <vector>

#include "awmr/model/gains_json.h"
#include "awmr/tune/settling.h"
#include "awmr/tune/tuning_steps.h"

namespace awmr {
namespace {

/// A mode uses its own gains if its objective with them is at most this share of that with the
/// gains for all modes.
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
  if (!tuning.robust) return tuning;
  keep_only(mode, tuning.robust->evaluated);
  keep_only(mode, tuning.robust->evaluated_by_scenario);
  keep_only(mode, tuning.robust->goals);
  return tuning;
}

/// True if the gains `own` have an objective that is lower by at least 5 % than with `common`, and
/// at least as many runs settle, or 95 % of them. `objective`: objective of the runs of one mode.
bool is_better(const Gains<double>& own, const Gains<double>& common, const Objective& objective) {
  const double limit = kWorthOwnGains * objective(common).objective;
  const ObjectiveSetting& runs = objective.setting();
  return objective(own).objective <= limit &&
         settled_share(runs, own) >= std::min(kSettledShare, settled_share(runs, common));
}

/// Replaces the objectives and scores of `tuning` (over all modes) by those in the runs of one
/// mode. They are relative to the baseline of `objective`, which is Tuning::baseline.
void evaluate_in(const Objective& objective, const Scenario& held_out, Tuning& tuning) {
  const Evaluation evaluation = objective(tuning.gains);
  tuning.objective = evaluation.objective;
  tuning.scores = evaluation.scores;
  tuning.baseline_objective = objective.baseline().objective;
  tuning.baseline_scores = objective.baseline().scores;
  ObjectiveSetting elsewhere = objective.setting();
  elsewhere.scenarios = {held_out};
  const Objective of_held_out(std::move(elsewhere), tuning.baseline.gains.common());
  const Evaluation held_out_evaluation = of_held_out(tuning.gains);
  tuning.held_out_objective = held_out_evaluation.objective;
  tuning.held_out_scores = held_out_evaluation.scores;
}

/// Returns the results for a mode that keeps the gains for all modes, `common`. `objective`: of the
/// runs of the mode, relative to its `baseline`.
Result<Tuning> kept(const Tuning& common, const Objective& objective, const Scenario& held_out,
                    Baseline baseline, const ModeTuning& steps) {
  const bool is_other =
      gains_to_json(baseline.gains.common()) != gains_to_json(common.baseline.gains.common());
  Tuning tuning = in_mode(common, *objective.setting().mode);
  tuning.baseline = std::move(baseline);
  evaluate_in(objective, held_out, tuning);
  if (!is_other) return tuning;
  // The trade-off is that of all modes, with the baseline of combined mode.
  std::erase_if(tuning.trade_off.named,
                [](const NamedTradeOff& one) { return one.gains == "baseline"; });
  AWMR_RETURN_IF_ERROR(steps.compare_with_baseline(tuning));
  return tuning;
}

}  // namespace

Result<std::optional<Tuning>> with_own_gains(const ObjectiveSetting& setting,
                                             const Scenario& held_out, const Tuning& common,
                                             const std::optional<Baseline>& requested,
                                             const ModeTuning& steps) {
  bool is_any_better = false;
  std::vector<Tuning> all;
  std::vector<ModeCertificate> certified;
  for (const YawMode mode : setting.modes()) {
    Result<Tuning> own = steps.search(mode);
    Baseline baseline = requested ? requested->in(mode) : common.baseline;
    AWMR_ASSIGN_OR_RETURN(ObjectiveSetting of_mode, steps.setting(mode));
    const bool is_used =
        own && is_better(own->gains, common.gains,
                         Objective(runs_in(std::move(of_mode), {}, mode), baseline.gains.common()));
    is_any_better = is_any_better || is_used;
    if (is_used) {
      all.push_back(*std::move(own));
    } else {
      const Objective objective(runs_in(setting, {}, mode), baseline.gains.common());
      AWMR_ASSIGN_OR_RETURN(Tuning same,
                            kept(common, objective, held_out, std::move(baseline), steps));
      all.push_back(std::move(same));
    }
    if (all.back().gains.observer.is_on()) all.back().observer_added |= common.observer_added;
    certified.push_back(all.back().certificate->modes.front());
  }
  if (!is_any_better) return std::optional<Tuning>();
  Tuning tuning = std::move(all.back());  // combined is the last mode
  all.pop_back();
  tuning.certificate->modes = std::move(certified);
  tuning.own = std::move(all);
  return std::optional(std::move(tuning));
}

}  // namespace awmr
