/// The families of resistance that a fit of logs may have. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

struct FamilyFit {
  Family surge = Family::kPower;
  Family yaw = Family::kPower;
  LogFitOptions options;  ///< with the terms of the families
  LogFit fit;
};

/// True once the limit of effort or of time is reached: no further model is tried.
bool is_over(const LogFitOptions& options);

/// The options with the optimum of `fit` as the only place to search from, with its delays and no
/// others, and nothing suspected.
LogFitOptions from_optimum(LogFitOptions options, const FamilyFit& fit);

/// The fit with the families' terms free. `power_law`: the options for a power law in both motions.
FamilyFit fit_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                     Family surge, Family yaw);

/// The fit of families from the optimum of `inner`, if it has one: from its nearest curves, and with
/// its own numbers and none of each term that it lacks.
FamilyFit fit_from(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const FamilyFit& inner, Family surge, Family yaw);

/// Returns `first`, or, if `alternative` is better, the result of another search for the families of
/// `first` from its optimum: a family must not win because another search failed.
FamilyFit searched_again(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         FamilyFit first, const FamilyFit& alternative);

/// Options of the comparison of families.
struct FamilyContest {
  bool surge = true;  ///< every family of surge resistance, otherwise power
  bool yaw = false;   ///< and of yaw resistance, given the best of surge
  double lead = 0.0;  ///< by which a family's AIC has to be below the power law's to be taken
  bool only_suspects = true;  ///< if no term improves the power law, it has no alternatives
};

struct BestFamily {
  FamilyFit best;
  std::vector<FamilyFit> others;
  std::vector<Finding>
      findings;  ///< `power-law-inadequate`, `family-undecided`, `families-not-compared`
  bool is_out_of_time = false;  ///< the limit was reached before every comparison was made
};

/// Their reports, with the AIC of each under the noise of `reference`.
std::vector<EstimatorReport> reports_of(const std::vector<FamilyFit>& fits,
                                        const FamilyFit& reference);

/// Number of fits of other families that best_family() makes, unless it reaches its limit.
std::size_t contender_count(const LogFitOptions& power_law, const FamilyFit& first,
                            const FamilyContest& contest);

/// The families in turn, each from the optimum of the best so far, so that a richer one does not end
/// above what it holds: the best of those that converged, compared as family_score.h says. `first`: the power law's fit, or that
/// of the families to begin with.
BestFamily best_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       FamilyFit first, const FamilyContest& contest);

/// "coulomb-linear", or "power, yaw coulomb-linear" where yaw has one of its own.
std::string families_in_words(Family surge, Family yaw);

}  // namespace awmr
