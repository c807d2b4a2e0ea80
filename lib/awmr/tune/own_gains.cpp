#include "awmr/tune/own_gains.h"

#include <utility>
#include <vector>

#include "awmr/tune/settling.h"

namespace awmr {
namespace {

/// A mode uses its own gains if they lower its objective to at most this share.
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
/// at least as many runs settle. `objective`: objective of the runs of one mode.
bool is_better(const Gains<double>& own, const Gains<double>& common, const Objective& objective) {
  const double limit = kWorthOwnGains * objective(common).objective;
  const ObjectiveSetting& runs = objective.setting();
  return objective(own).objective <= limit &&
         settled_share(runs, own) >= settled_share(runs, common);
}

/// Replaces the objectives of `tuning` (over all modes) by the objectives in the runs of one mode.
void evaluate_in(const Objective& objective, const Scenario& held_out, Tuning& tuning) {
  tuning.objective = objective(tuning.gains).objective;
  tuning.baseline_objective = objective.baseline().objective;
  ObjectiveSetting elsewhere = objective.setting();
  elsewhere.scenarios = {held_out};
  const Objective of_held_out(std::move(elsewhere), tuning.baseline.gains.common());
  tuning.held_out_objective = of_held_out(tuning.gains).objective;
}

}  // namespace

std::optional<Tuning> with_own_gains(const ObjectiveSetting& setting, const Scenario& held_out,
                                     const Tuning& common,
                                     const std::function<Result<Tuning>(YawMode)>& search) {
  bool is_any_better = false;
  std::vector<Tuning> all;
  std::vector<ModeCertificate> certified;
  for (const YawMode mode : setting.modes()) {
    Result<Tuning> own = search(mode);
    const Objective objective(runs_in(setting, {}, mode), common.baseline.gains.common());
    const bool is_used = own && is_better(own->gains, common.gains, objective);
    is_any_better = is_any_better || is_used;
    all.push_back(is_used ? *std::move(own) : in_mode(common, mode));
    if (!is_used) evaluate_in(objective, held_out, all.back());
    if (all.back().gains.observer.is_on()) all.back().observer_added |= common.observer_added;
    certified.push_back(all.back().certificate->modes.front());
  }
  if (!is_any_better) return std::nullopt;
  Tuning tuning = std::move(all.back());  // combined is the last mode
  all.pop_back();
  tuning.certificate->modes = std::move(certified);
  tuning.own = std::move(all);
  return tuning;
}

}  // namespace awmr
