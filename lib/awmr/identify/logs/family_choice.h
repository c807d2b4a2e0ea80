/// Selection of the resistance families of a log fit. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

struct FamilyFit {
  Family surge = Family::kPower;
  Family yaw = Family::kPower;
  LogFitOptions options;  ///< with the terms of the families free
  LogFit fit;
};

/// True if the limit of effort or time is reached; no further model is then fitted.
bool is_over(const LogFitOptions& options);

/// The options with the optimum of `fit` as the only start, with its delays and no others, and
/// without candidate terms.
LogFitOptions from_optimum(LogFitOptions options, const FamilyFit& fit);

/// Fits with the terms of the families free. `power_law`: the options for a power law in both
/// motions.
FamilyFit fit_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                     Family surge, Family yaw);

/// Fits families from the optimum of `inner`, if it has one. Starts: the curves nearest to those of
/// `inner`, and the values of `inner` with 0 for terms that it lacks.
FamilyFit fit_from(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const FamilyFit& inner, Family surge, Family yaw);

/// Returns `first`. If `alternative` is better, first repeats the search for the families of
/// `first` from the optimum of `alternative`, so that no family is selected only because another
/// search failed.
FamilyFit searched_again(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         FamilyFit first, const FamilyFit& alternative);

/// Options of the comparison of families.
struct FamilyContest {
  bool surge = true;  ///< compares all families of surge resistance; false: power law
  bool yaw = false;   ///< compares all families of yaw resistance, given the best one of surge
  double lead = 0.0;  ///< a family replaces the power law if its AIC is lower by this
  bool only_suspects = true;  ///< if no candidate term improves the power law, no other family is
                              ///< fitted
};

struct BestFamily {
  FamilyFit best;
  std::vector<FamilyFit> others;
  std::vector<Finding>
      findings;  ///< `power-law-inadequate`, `family-undecided`, `families-not-compared`
  bool is_out_of_time = false;  ///< the limit was reached before all comparisons
};

/// Reports of the fits, each with its AIC under the noise of `reference`.
std::vector<EstimatorReport> reports_of(const std::vector<FamilyFit>& fits,
                                        const FamilyFit& reference);

/// Number of fits of other families by best_family(), unless it reaches its limit.
std::size_t contender_count(const LogFitOptions& power_law, const FamilyFit& first,
                            const FamilyContest& contest);

/// Fits the families in turn and returns the best converged one (family_score.h). Each starts from
/// the best optimum so far, so that a family is not worse than one that it contains. `first`: the
/// fit of the power law, or of other families to begin with.
BestFamily best_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       FamilyFit first, const FamilyContest& contest);

/// "coulomb-linear", or "power, yaw coulomb-linear" if yaw has a different family.
std::string families_in_words(Family surge, Family yaw);

}  // namespace awmr
