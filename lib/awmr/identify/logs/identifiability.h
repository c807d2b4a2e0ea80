/// Covariance of the quantities of a log fit, and the quantities that the logs do not identify.
/// Private to identify/.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "awmr/identify/logs/information.h"
#include "awmr/identify/logs/log_problem.h"

namespace awmr {

/// A coordinate whose standard error reaches this share of its large change is not identified: at
/// 95 % a factor of 2.7 in either direction for a logarithm, +-1 for an exponent.
inline constexpr double kUnknown = 0.5;

struct Identifiability {
  /// n x n, of the coordinates. Non-identifiable coordinates have a large variance, which
  /// propagates to all correlated coordinates.
  Eigen::MatrixXd covariance;
  std::vector<double> degrees_of_freedom;  ///< of the standard errors, by quantity
  std::vector<std::string> why_not;        ///< by quantity; empty if it is identified
  int rank = 0;                            ///< number of directions that the logs determine
  double condition_number = 0.0;  ///< of the Jacobian, coordinates over their large changes
  /// By quantity: factor on the standard error, from the scatter of blocks of residuals relative to
  /// their noise model; >= 1.
  std::vector<double> factor;

  double widened() const { return factor.empty() ? 1.0 : std::ranges::max(factor); }
};

/// Computes the covariance from the information H (n x n) and, to allow for errors of the noise
/// model, from the scores s_b of m parts of the logs. With coordinates divided by their large
/// changes and a weak prior P,
///
///     C = (H + P)^-1,   V = m/(m - 1) C (sum s_b s_b^T) C,   covariance = D C D,
///     D_ii^2 = max(1, V_ii / C_ii)
///
/// The parts are blocks. With three or more logs, the parts are also whole logs, if these scatter
/// significantly more (5 %), as with a model error that differs between logs. A quantity is refused
/// if its standard error reaches half of its large change, or if it has a tenth or more of the
/// squared length of a direction that the logs do not determine.
Identifiability identifiability(const Eigen::MatrixXd& information, const Scores& scores,
                                const std::vector<FreeQuantity>& quantities);

/// Refuses a coordinate that the search left at an end of its range, which is not an estimate. Also
/// refuses coordinates correlated with it, a factor without the other terms of its resistance, and
/// an exponent without its factor.
Identifiability without_stopped(Identifiability found, const LogProblem& problem,
                                const std::vector<double>& coordinates);

}  // namespace awmr
