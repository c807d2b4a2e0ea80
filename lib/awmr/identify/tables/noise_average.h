/// One resistance law under every statement of where the runs' errors lie. Private to identify/.
///
/// A table does not say where its errors lie: on the force, a factor on it (a distance that was
/// measured short is one, too), on the rate that was read, or on the time. The fits differ by more than each of them
/// says of itself, so that the shown interval is that of all of them, each with the probability that
/// the runs give it. That is the likelihood with the law's numbers and the deviation s integrated out,
/// flat in the numbers and in ln s, as a density of the measured rates' logarithms, so that errors of
/// different units compare:
///
///     ln w_k = -n ln s_k + 1/2 ln det C_k + sum_i ln |d e_ki/d ln w_i| + constant
///
/// with e the residuals in the unit of the error: |d e/d ln w| is w g'/(g + z) for a factor on the
/// force, w g' for the force, w for the rate, t for the time.
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

/// The fit whose value is shown keeps at least this probability: half of it lies on either side of
/// the value, which therefore never lies outside of the 95 % interval.
inline constexpr double kLeastOwnWeight = 0.05;

/// The chosen fit first, then the same family under the other noise models, where those fits are usable
/// and free the same numbers. The chosen one alone where `options` name the noise or a robust loss,
/// or it has no degrees of freedom. `candidates`: fits that are there already.
std::vector<NoiseAlternative> noise_alternatives(const Subject& subject,
                                                 const SubjectOptions& options,
                                                 const SteadyProblem& problem,
                                                 const SteadyFit& chosen,
                                                 const std::vector<FamilyCandidate>& candidates);

/// Over SteadyFit::free of the chosen fit; empty where it has no covariance.
Posterior posterior_of(const std::vector<NoiseAlternative>& alternatives);

}  // namespace awmr
