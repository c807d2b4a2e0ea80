/// Selection of the surge and yaw resistance families of a log fit. Private to identify/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// A log fit under one surge family and one yaw family.
struct FamilyFit {
  Family surge = Family::kPower;
  Family yaw = Family::kPower;
  LogFitOptions options;  ///< options of the fit; the terms of both families are free
  LogFit fit;
};

/// True if the limit of effort or of time is reached, so that no further model is to be fitted.
bool is_over(const LogFitOptions& options);

/// Returns the options for a fit that starts only at the optimum of `fit`. It has the delays and
/// command errors of `fit`, searches no others and tests no candidate terms.
LogFitOptions from_optimum(LogFitOptions options, const FamilyFit& fit);

/// Fits the logs under the families `surge` and `yaw`. `power_law`: options of a fit of power laws.
FamilyFit fit_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                     Family surge, Family yaw);

/// Fits the logs under the families `surge` and `yaw`, starting from the optimum of `inner`, a fit
/// of other families. There are two starts: the curves of the new families nearest to those of
/// `inner`, and the values of `inner`, with the initial guess of `power_law` for terms that are 0
/// in `inner`. If `inner` did not converge, as fit_family().
FamilyFit fit_from(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const FamilyFit& inner, Family surge, Family yaw);

/// If `alternative` is better than `first`, repeats the search for the families of `first` from the
/// optimum of `alternative`, so that `first` does not lose only because its search failed. Returns
/// `first` or, if better, the repeated fit.
FamilyFit searched_again(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         FamilyFit first, const FamilyFit& alternative);

/// Options of best_family(), which compares other families with those of a fit `first`.
struct FamilyContest {
  bool surge = true;  ///< true: compares all surge families; false: keeps that of `first`
  bool yaw = false;   ///< true: compares all yaw families; false: keeps that of `first`
  double lead = 0.0;  ///< another family replaces that of `first` if its AIC is lower by more
  /// True: fits other families only if a score test or a slow drift suggests a missing term, or if
  /// `first` did not converge.
  bool only_candidates = true;
};

/// Result of best_family().
struct BestFamily {
  FamilyFit best;
  std::vector<FamilyFit> others;  ///< the other fits that were made
  /// `power-law-inadequate`, `family-undecided`, `families-not-compared`, where they apply.
  std::vector<Finding> findings;
  /// True: the limit of effort or time was reached before all comparisons were done.
  bool is_out_of_time = false;
};

/// Reports of the fits for /estimates, each with its AIC under the noise of `reference`.
std::vector<EstimatorReport> reports_of(const std::vector<FamilyFit>& fits,
                                        const FamilyFit& reference);

/// Number of other families that best_family() fits at least once each; close losers may be fitted
/// again. It fits fewer if the limit of effort or time is reached (FamilyContest).
std::size_t contender_count(const LogFitOptions& power_law, const FamilyFit& first,
                            const FamilyContest& contest);

/// Fits the families in turn and returns the best converged fit, compared as in family_score.h.
/// Each fit starts from the best optimum so far, so that a family is not worse than a special case
/// of it. `first`: the fit to improve on, usually of power laws.
BestFamily best_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       FamilyFit first, const FamilyContest& contest);

/// Names the surge family, and the yaw family unless that is the power law: "coulomb-linear",
/// "power, yaw coulomb-linear".
std::string families_in_words(Family surge, Family yaw);

}  // namespace awmr
