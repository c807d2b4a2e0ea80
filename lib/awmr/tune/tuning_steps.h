/// Steps of tune() that have files of their own, in the order of their use. Private to tune/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/objective.h"
#include "awmr/tune/search.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Checks the options of a search. Errors (input): all options that are out of range or contradict
/// another option.
Status check_options(const TuneOptions& options, const Vehicle& vehicle);

/// Inputs of the search, for all modes: the setting of the runs and the context of the constraints.
struct TuningProblem {
  ObjectiveSetting setting;
  ConstraintContext context;
  std::optional<RobustTuning> robust;  ///< without results; absent for nominal gains
};

/// Tunes for one mode, or for all modes if `mode` is absent: search_gains(), then the evaluation on
/// newly drawn vehicles and the causes of runs that do not settle. Errors: those of tune().
Result<Tuning> tune_for(std::optional<YawMode> mode, const Model& model, TuningProblem problem,
                        TuneOptions options, const Scenario& held_out);

/// Searches the gains on one setting, then evaluates them in the scenario `held_out`, which the
/// search does not use. If runs need an observer to settle (TuneOptions::adds_observer), searches
/// again with an observer. Errors: those of tune().
Result<Tuning> search_gains(const Model& model, const ObjectiveSetting& setting,
                            const ConstraintContext& context, const TuneOptions& requested,
                            const Scenario& held_out);

/// Gains with the ranges of mu and mu_s in which the objective is nearly constant. The lower ends
/// are those of `gains`.
struct SettledGains {
  Gains<double> gains{};
  /// Range of mu, rad/s^2, at constant mu/epsilon.
  Interval mu;
  /// Range of mu_s, m/s^2, at constant mu_s/epsilon_s and with the smallest mu.
  Interval speed_mu;
};

/// Reduces mu of the best gains, then mu_s, at constant mu/epsilon and mu_s/epsilon_s. Inside the
/// boundary layers only these two ratios act, so without this rule the seed of the search would
/// determine mu. Selects the smallest mu that meets every constraint and whose objective is at most
/// kIndifferent/2 worse than that of `best`, on the drawn vehicles of the search (`searched`). Then
/// selects the smallest mu_s with an objective at most kIndifferent worse.
///
/// On all drawn vehicles (`all`), the reduced gains must also meet the constraints and be at most
/// kIndifferent worse than `best`. Otherwise both reductions are made smaller (kReductions), or
/// `best` is kept.
SettledGains settle(const TuneOptions& options, const ConstraintContext& context,
                    const Objective& searched, const Objective& all, const Candidate& best);

/// Returns the constraints that are active at `best` (within 1 % of the limit), each with the
/// improvement of the objective by a local search in which this constraint is relaxed by kWider.
/// Errors: those of search().
Result<std::vector<ActiveConstraint>> active_constraints(const TuneOptions& options,
                                                         const ConstraintContext& context,
                                                         const Objective& objective,
                                                         const Candidate& best);

/// Returns the Pareto-optimal points: no other point has both a shorter settling time and a smaller
/// control variation. Sorted by settling time.
std::vector<FrontPoint> front_of(std::vector<FrontPoint> points);

/// Returns the Pareto front of `met`, the feasible gains of a search, and the points of named gains
/// such as the paper's (TradeOff::named), simulated in the runs of that search.
TradeOff trade_off_of(const Objective& searched, const ConstraintContext& context,
                      std::vector<FrontPoint> met, const Gains<double>& tuned,
                      const Gains<double>& baseline);

/// Returns every requirement of the search that the baseline gains do not meet: constraints,
/// requested bounds, activity limit and goals that are not soft. `objective`: the objective on the
/// nominal vehicle and all drawn vehicles, normalised by the baseline gains. `requested`: the
/// options as the user gave them, so that default bounds of the gains do not count.
std::vector<ConstraintReport> violated_by_baseline(const Gains<double>& baseline,
                                                   const Objective& objective,
                                                   const ConstraintContext& context,
                                                   const TuneOptions& requested);

/// Evaluates gains in the scenario `held_out`, with the vehicles and modes of the setting.
Evaluation evaluate_held_out(ObjectiveSetting setting, const Scenario& held_out,
                             const Gains<double>& baseline, const Gains<double>& gains);

/// Error if no gains meet the constraints that need no simulation. `nearest`: the gains with the
/// smallest violation. The message names the constraint that they violate most, and each change of
/// a single limit or bound in `requested` that alone permits gains.
tl::unexpected<Error> infeasible(const Candidate& nearest, const ConstraintContext& context,
                                 const TuneOptions& requested);

/// Error if no gains meet the limits that need simulated runs. The message names what the gains
/// with the smallest violation miss most: a goal, an activity limit or a constraint.
tl::unexpected<Error> not_found(const SearchResult& found, const Objective& objective,
                                const ConstraintContext& context, const TuneOptions& requested);

/// Error if gains meet every limit but none of the `runs` runs settles. The message names the
/// `changes` with which runs settle.
tl::unexpected<Error> never_settles(const Gains<double>& gains, std::size_t runs,
                                    const std::vector<SettlingChange>& changes,
                                    const TuneOptions& requested);

/// Error (refused) if in some mode the tuned gains never settle (UnsettledRuns::is_never) in any
/// scenario, unless TuneOptions::allows_unsettled is set or the mode cannot turn the vehicle. The
/// message names the causes and the changes with which runs settle.
Status check_settled(const Tuning& tuning, const TuneOptions& requested);

/// Gains settle much faster than others if their mean settling time is at most this share.
inline constexpr double kMuchFaster = 0.75;

/// Searches gains for each mode alone. A mode keeps the gains of `common` in three cases: its
/// search fails; its objective falls by less than 5 %, and either rises or the own gains do not
/// settle much faster (kMuchFaster); or fewer of its runs settle, unless 95 % settle. Both are
/// compared in the setting of the search for the mode, whose scenarios can be shorter
/// (TuneOptions::has_default_scenarios). Returns one Tuning with all modes: the gains of combined
/// mode in Tuning::gains, those of the other modes in Tuning::own, and a certificate for all modes.
/// Returns `common` if all modes keep its gains.
///
/// `problem`: the problem for which `common` was tuned for all modes. If the file of
/// TuneOptions::baseline has gains by mode, a mode that keeps `common` is compared with those of
/// this mode. Errors (input): those of default_tuning_scenario() and vehicles_of(); no wheel force
/// is left for an observer.
Result<Tuning> tune_by_mode(const Model& model, const TuningProblem& problem,
                            const TuneOptions& options, const Scenario& held_out, Tuning common);

}  // namespace awmr
