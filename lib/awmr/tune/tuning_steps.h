/// Steps of tune() that have files of their own, in order: check of the options, search of the
/// gains, gains by mode. Private to tune/.
#pragma once

#include <functional>
#include <optional>

#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/model/vehicle.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Checks the options of a search. Errors (input): all options that are out of range or contradict
/// another option.
Status check_options(const TuneOptions& options, const Vehicle& vehicle);

/// Searches the gains on one setting, then evaluates them in the scenario `held_out`, which the
/// search does not use. If runs need an observer to settle (TuneOptions::adds_observer), searches
/// again with an observer. Errors: those of tune().
Result<Tuning> search_gains(const Model& model, const ObjectiveSetting& setting,
                            const ConstraintContext& context, const TuneOptions& requested,
                            const Scenario& held_out);

/// Steps for one mode, in the setting of the search for all modes.
struct ModeTuning {
  /// Setting of a search for the mode alone. Its scenarios can be shorter than those of the search
  /// for all modes (TuneOptions::has_default_scenarios).
  std::function<Result<ObjectiveSetting>(YawMode)> setting;
  /// Tunes for the mode alone, in `setting`.
  std::function<Result<Tuning>(YawMode)> search;
  /// Computes again those results for a mode (Tuning::mode) that depend on its baseline,
  /// Tuning::baseline: the limits that it violates, and the runs of newly drawn vehicles.
  std::function<Status(Tuning&)> compare_with_baseline;
};

/// Searches gains for each mode alone. A mode keeps the gains of `common` if its search fails, if
/// its objective falls by less than 5 %, or if fewer of its runs settle, unless 95 % settle. Both
/// are compared in ModeTuning::setting. Returns one Tuning with all modes: the gains of combined
/// mode in Tuning::gains, those of the other modes in Tuning::own, and a certificate for all modes.
/// Empty if all modes keep the gains of `common`.
///
/// `setting`: the setting in which `common` was tuned for all modes. `held_out`: a scenario that
/// the searches do not use. `requested`: TuneOptions::baseline; if the file of the baseline has
/// gains by mode, a mode that keeps `common` is compared with those of this mode. Errors: those of
/// ModeTuning::compare_with_baseline.
Result<std::optional<Tuning>> with_own_gains(const ObjectiveSetting& setting,
                                             const Scenario& held_out, const Tuning& common,
                                             const std::optional<Baseline>& requested,
                                             const ModeTuning& steps);

}  // namespace awmr
