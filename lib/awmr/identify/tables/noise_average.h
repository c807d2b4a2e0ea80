/// Interval of a resistance law averaged over the error models. Private to identify/.
///
/// A table does not show which quantity has the measurement error (error model): the force
/// (absolute or relative), the rate (speed or yaw rate) or the time. Fits under different error
/// models can differ by more than their intervals. The reported interval therefore averages over
/// all error models k, each weighted by its posterior probability p_k:
///
///     ln p_k = -n ln s_k + 1/2 ln det C_k + sum_i ln |d e_ki/d ln w_i| + constant
///
/// for n runs with the rates w_i, residuals e_ki of standard deviation s_k in the unit of the
/// error, and the covariance C_k of the fit. Up to a factor, p_k is the likelihood with the
/// parameters and s_k integrated out, under priors that are flat in the parameters and in ln s_k.
/// The likelihood is a density of ln w_i under every error model, so that error models with
/// different units can be compared. g is the resistance, g' its derivative with respect to the rate
/// w, z the dead zone and t the time of the run. |d e/d ln w| is then w g'/(g + z) for a relative
/// error of the force, w g' for an absolute one, w for the rate and t for the time.
///
/// If the chosen fit has the error of the time because the rates follow from times alone
/// (only_timed()), p_k of this error model is multiplied by kTimedOdds: a stop-watch has an error,
/// and a few runs cannot show it. The fast runs, whose speed it makes uncertain, are also those
/// that determine the curve there, so that their residuals are small.
#pragma once

#include <algorithm>
#include <vector>

#include "awmr/identify/tables/table_family.h"
#include "awmr/identify/uncertainty/posterior.h"

namespace awmr {

/// A fit under one error model and the posterior probability of that error model.
struct NoiseAlternative {
  ErrorModel noise = ErrorModel::kLogForce;
  SteadyFit fit;
  double weight = 1.0;  ///< probability of the error model, in (0, 1]; all add up to 1
};

/// Smallest weight of the chosen fit, whose value is the reported value. Half of this fit's
/// distribution lies on each side of that value. With a weight of 5 %, at least 2.5 % of the
/// mixture lies on each side, so the 95 % interval always contains the reported value.
inline constexpr double kMinOwnWeight = 0.05;

/// Returns the weight `own` of the chosen fit, raised so that it is at least the share kMinOwnWeight
/// of all weights. `others`: sum of the other weights. The caller divides all weights by their sum.
inline double raised_own_weight(double own, double others) {
  return std::max(own, others * kMinOwnWeight / (1.0 - kMinOwnWeight));
}

/// Prior odds of an error of the time against each other error model, for runs that were only timed.
inline constexpr double kTimedOdds = 20.0;

/// Returns the chosen fit, then the usable fits of the same family with the same free parameters
/// under the other error models. Returns only the chosen fit if the user selected the error model
/// or a robust loss, or if the chosen fit has no degrees of freedom. `candidates`: fits that were
/// already made, and are reused.
std::vector<NoiseAlternative> noise_alternatives(const Subject& subject,
                                                 const SubjectOptions& options,
                                                 const SteadyProblem& problem,
                                                 const SteadyFit& chosen,
                                                 const std::vector<FamilyCandidate>& candidates);

/// Distribution of the fitted coordinates (SteadyFit::free): the mixture of the alternatives with
/// their weights. Empty if a fit has no covariance.
Posterior posterior_of(const std::vector<NoiseAlternative>& alternatives);

}  // namespace awmr
