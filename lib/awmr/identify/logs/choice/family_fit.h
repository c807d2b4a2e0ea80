/// Log fits with given resistance families of surge and yaw. A family is a form of the resistance
/// law, for example a power law. And the comparison of two fits by AIC. Private to identify/.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/identify/logs/problem/score_test.h"

namespace awmr {

/// A log fit under one surge family and one yaw family.
struct FamilyFit {
  Family surge = Family::kPower;
  Family yaw = Family::kPower;
  LogFitOptions options;  ///< options of the fit; they free the terms of both families
  LogFit fit;
};

/// Sum of the squares of errors, and their number.
struct SquareSum {
  double squares = 0.0;
  double count = 0.0;

  void add(const std::vector<ErrorSeries>& errors);
};

/// Sum of n ln(sum e^2/n) over all sensors, with the n errors e of a sensor in all of these fits,
/// and the number of errors of all sensors.
struct ErrorSize {
  double size = 0.0;
  double count = 0.0;
};
ErrorSize size_of_errors(std::initializer_list<const LogFit*> fits);

/// AIC of a fit's errors under the noise model `noise`; smaller is better. With the innovations
/// nu_k of all channels, their variances S_k (whitener.h) and n free quantities,
///
///     AIC = sum (ln S_k + nu_k^2/S_k) + 2 n
///
/// `most`: limit of each nu_k^2/S_k.
double aic_under(const NoiseLevels& noise, const LogFit& fit, double most = kNoLimit);

/// AIC of `b` minus AIC of `a`, under the noise model of the fit with the smaller errors: > 0 if
/// `a` is better. Infinity if only `a` is usable, -infinity if only `b` is, 0 if neither is.
///
/// Reason for one noise model: each fit estimates its own noise, and the drift in this noise
/// absorbs the error of the fit's own model. If each fit used its own noise model, a fit with a
/// smooth error of 0.2 m/s could be likelier than a fit with an error of 3 mm/s.
///
/// `most`: as in aic_under(). With kMaxSquaredInnovation, each innovation counts as at most three
/// standard deviations, so that a few rows do not decide.
double aic_lead(const LogFit& a, const LogFit& b, double most = kNoLimit);
inline constexpr double kMaxSquaredInnovation = 9.0;

/// The problem of a fit, and its solution. Empty if its windows are not those of the fit.
std::optional<Extended> solution_of(const std::vector<DrivingLog>& logs, const FamilyFit& solved);

/// True if the limit of work (Effort) or of time is reached, so that no further fit may begin.
bool is_over(const LogFitOptions& options);

/// Returns the options of a fit with a single start, the optimum of `fit`. The new fit has the
/// delays and command errors of `fit`, and does not search for further ones.
LogFitOptions from_optimum(LogFitOptions options, const FamilyFit& fit);

/// Resets each term in `values` that the next fit does not estimate (not in `free`) to its value in
/// `power_law`. Without this reset, the term would keep the value that an earlier fit estimated.
void reset_terms(const std::vector<ParameterId>& free, const ParameterValues<double>& power_law,
                 ParameterValues<double>& values);

/// Fits the logs under the families `surge` and `yaw`, whose terms `options` must already free.
FamilyFit fit_with(const std::vector<DrivingLog>& logs, LogFitOptions options, Family surge,
                   Family yaw);

/// Fits the logs under the families `surge` and `yaw`. `power_law`: options of a fit of power laws,
/// to which this function adds the terms of the families.
FamilyFit fit_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                     Family surge, Family yaw);

/// Fits the logs under the families `surge` and `yaw`, starting from the optimum of `inner`, a fit
/// of other families. `more`: further terms to estimate. Starts two searches:
///   - from the curves of the new families that are nearest to the fitted curves of `inner`;
///   - from the parameter values of `inner`. Terms that are 0 in `inner` start at the initial guess
///     of `power_law`.
///
/// If `inner` did not converge, returns fit_family() without the terms `more`.
FamilyFit fit_from(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                   const FamilyFit& inner, Family surge, Family yaw,
                   const std::vector<FreeTerm>& more = {});

/// Makes a rough fit (fit_roughly()) of the families `surge` and `yaw`, starting from their curves
/// that are nearest to the fitted curves of `inner`. `more`: further terms to estimate.
FamilyFit fit_roughly_from(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                           const FamilyFit& inner, Family surge, Family yaw,
                           const std::vector<FreeTerm>& more);

/// Searches delays, lags and command errors again for the families of `fit`, starting at its
/// optimum. If the errors of `fit` are much larger than the sensor noise (LogFit::relative_error
/// 1.2 or more), or if one of its terms is not significant, the search starts without any of these
/// terms, because they may only have compensated for a wrong resistance or wrong commands.
FamilyFit with_new_terms(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         const FamilyFit& fit);

/// Returns `options` for fits that compete with `best`. To save time, they stop early if they are
/// much worse (is_far_worse() in multistart.h), or if LogFit::relative_error exceeds that of `best`
/// by more than 50 %. No limits if `best` is not usable.
LogFitOptions with_limits_of(const FamilyFit& best, const std::vector<DrivingLog>& logs,
                             LogFitOptions options);

/// with_limits_of() for a fit that replaces `best` only if its AIC is lower by more than
/// kFamilyAicThreshold. It also stops early if its quick searches show hardly any gain. Without
/// this condition if the errors of `best` have a slow drift: a term can then lower AIC although it
/// hardly lowers the mean square error.
LogFitOptions with_limits_for_gain(const FamilyFit& best, const std::vector<DrivingLog>& logs,
                                   LogFitOptions options);

/// Fits the logs with Coulomb, linear and Stribeck friction of the yaw rate (`of_yaw`) or the
/// speed. Starts from the optimum of `inner`, a usable fit of other families.
FamilyFit fit_stribeck(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       const FamilyFit& inner, bool of_yaw);

/// Gives the families of `first` a second chance, because the search of `first` may have failed: if
/// the AIC of `alternative` is lower than that of `first` by more than 2, fits the families of
/// `first` again from the optimum of `alternative`. Returns the better of `first` and the new fit.
FamilyFit searched_again(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                         FamilyFit first, const FamilyFit& alternative);

/// Names the surge family and, if it is not the power law, the yaw family. Examples:
/// "coulomb-linear", "power, yaw coulomb-linear".
std::string families_in_words(Family surge, Family yaw);

}  // namespace awmr
