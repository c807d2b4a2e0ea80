/// Log fits under given surge and yaw resistance families. Private to identify/.
#pragma once

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

/// True if the limit of effort or of time is reached, so that no further model may be fitted.
bool is_over(const LogFitOptions& options);

/// Returns the options for a fit that starts only at the optimum of `fit`. The new fit has the
/// delays and command errors of `fit` and searches no others.
LogFitOptions from_optimum(LogFitOptions options, const FamilyFit& fit);

/// Fits the logs under the families `surge` and `yaw`. Precondition: `options` already frees the
/// terms of these families.
FamilyFit fit_with(const std::vector<DrivingLog>& logs, LogFitOptions options, Family surge,
                   Family yaw);

/// Fits the logs under the families `surge` and `yaw`. `power_law`: options of a fit of power laws.
FamilyFit fit_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                     Family surge, Family yaw);

/// Fits the logs under the families `surge` and `yaw`, starting from the optimum of `inner`, a fit
/// of other families. Starts two searches:
///   - from the curves of the new families that are nearest to the curves of `inner`;
///   - from the values of `inner`. Terms that are 0 in `inner` start at the initial guess of
///     `power_law`.
/// If `inner` did not converge, returns fit_family(), without `more`. `more`: further terms to
/// estimate.
FamilyFit fit_from(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const FamilyFit& inner, Family surge, Family yaw,
                   const std::vector<FreeTerm>& more = {});

/// Calls fit_roughly() under the families `surge` and `yaw`, starting from the curves of these
/// families that are nearest to the curves of `inner`.
FamilyFit fit_roughly_from(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                           const FamilyFit& inner, Family surge, Family yaw,
                           const std::vector<FreeTerm>& more);

/// Fits the logs with Coulomb, linear and Stribeck friction of the yaw rate (`of_yaw`) or the
/// speed, starting from the optimum of `inner`, a usable fit of other families.
FamilyFit fit_stribeck(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       const FamilyFit& inner, bool of_yaw);

/// If the AIC of `alternative` is lower than that of `first` by more than 2, repeats the search for
/// the families of `first` from the optimum of `alternative`, so that `first` does not lose only
/// because its search failed. Returns `first` or, if better, the repeated fit.
FamilyFit searched_again(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         FamilyFit first, const FamilyFit& alternative);

/// Names the surge family, and also the yaw family unless it is the power law. Examples:
/// "coulomb-linear", "power, yaw coulomb-linear".
std::string families_in_words(Family surge, Family yaw);

}  // namespace awmr
