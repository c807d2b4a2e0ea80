/// Average of one resistance law over the noise models. Private to identify/.
///
/// A table does not state whether its errors are absolute or relative errors of the force (a wrong
/// distance acts as a relative one), errors of the rate, or of the time. The fits under these noise
/// models differ by more than their own intervals. The reported interval therefore averages over
/// all of them, each weighted by its posterior probability. That is the likelihood with the
/// parameters and the standard deviation s integrated out, with priors flat in the parameters and
/// in ln s. It is a density of the logarithms of the measured rates, so that noise models of
/// different units are comparable:
///
///     ln w_k = -n ln s_k + 1/2 ln det C_k + sum_i ln |d e_ki/d ln w_i| + constant
///
/// with e the residuals in the unit of the error: |d e/d ln w| is w g'/(g + z) for a relative error
/// of the force, w g' for the force, w for the rate, t for the time.
#pragma once

#include <vector>

#include "awmr/identify/tables/family_choice.h"
#include "awmr/identify/uncertainty/posterior.h"

namespace awmr {

struct NoiseAlternative {
  ErrorModel noise = ErrorModel::kLogForce;
  SteadyFit fit;
  double weight = 1.0;  ///< in (0, 1]; they add up to 1
};

/// Smallest probability of the chosen fit, whose value is reported. Half of it is on either side of
/// the value, so the value is always within the 95 % interval.
inline constexpr double kLeastOwnWeight = 0.05;

/// The chosen fit, then the fits of the same family under the other noise models that are usable
/// and have the same free parameters. Only the chosen fit if `options` select the noise or a robust
/// loss, or if it has no degrees of freedom. `candidates`: existing fits, which are reused.
std::vector<NoiseAlternative> noise_alternatives(const Subject& subject,
                                                 const SubjectOptions& options,
                                                 const SteadyProblem& problem,
                                                 const SteadyFit& chosen,
                                                 const std::vector<FamilyCandidate>& candidates);

/// Over SteadyFit::free of the chosen fit; empty if it has no covariance.
Posterior posterior_of(const std::vector<NoiseAlternative>& alternatives);

}  // namespace awmr
