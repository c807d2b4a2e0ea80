/// Covariance of a log fit, and the decision which quantities the logs identify. The search changes
/// the coordinate of a quantity: its value or the logarithm of it. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "awmr/identify/logs/problem/information.h"
#include "awmr/identify/logs/problem/log_problem.h"

namespace awmr {

/// Limit of the standard error of an identified quantity, in large changes. (A large change,
/// FreeQuantity::large_change, is 1 for a logarithm or an exponent.) At this limit, the 95 %
/// interval of a quantity with a logarithmic coordinate extends from 1/2.7 to 2.7 times its value,
/// and that of an exponent is +-1.
inline constexpr double kUnknown = 0.5;

/// Covariance and identifiability of the n coordinates of a log fit.
struct Identifiability {
  /// Covariance of the coordinates, n x n. A coordinate that the logs do not identify has a large
  /// variance, which also makes the variances of all correlated coordinates larger.
  Eigen::MatrixXd covariance;
  /// Degrees of freedom of each standard error, one per quantity.
  std::vector<double> degrees_of_freedom;
  /// One per quantity; empty text: the quantity is identified.
  std::vector<std::string> refusal_reason;
  int rank = 0;  ///< number of directions that the logs determine
  /// Condition number of the Jacobian, with coordinates in units of large changes.
  double condition_number = 0.0;
  /// One per quantity: factor >= 1 by which its standard error was raised, because parts of the
  /// logs scatter more than the noise model predicts.
  std::vector<double> factor;

  /// Largest of the factors.
  double widened() const { return factor.empty() ? 1.0 : std::ranges::max(factor); }
};

/// Computes the covariance of the coordinates and decides which quantities are identified.
///
/// The covariance follows from the information matrix H (n x n), a weak prior P, and the scores s_b
/// of m parts of the logs: the gradients of -ln L of a part with respect to the coordinates. If the
/// noise model is wrong, the scores scatter more than it predicts, and the standard errors are
/// raised. C is the covariance by the noise model, V that by the scatter. In units of large changes
/// (FreeQuantity::large_change),
///
///     C = (H + P)^-1,   V = m/(m - 1) C (sum s_b s_b^T) C,   covariance = D C D,
///     D_ii^2 = max(1, V_ii / C_ii)
///
/// The parts are blocks of some seconds. With three or more logs, whole logs are a second kind of
/// parts, because a model error can differ between logs. Whole logs count only if their scatter
/// exceeds the prediction significantly (5 %). Of the D_ii from blocks and from whole logs, the
/// larger one then applies.
///
/// A quantity gets no value for one of two reasons:
///   - Its standard error exceeds kUnknown large changes (half of that for the sway resistance).
///   - It contributes a tenth or more to the squared length of a direction (eigenvector of H) that
///     the logs do not determine.
Identifiability identifiability(const Eigen::MatrixXd& information, const Scores& scores,
                                const std::vector<FreeQuantity>& quantities);

/// Refuses every quantity (gives it no value) whose search ended at an end of its range, and every
/// quantity whose correlation with such a quantity exceeds 0.3 in magnitude. If a term of a
/// resistance is refused, also refuses the parameters that have no meaning without it: alpha, if
/// the Coulomb friction c, the quadratic coefficient q or the dead zone is refused; c or q below two
/// standard errors, and the exponent beta, if alpha is refused.
Identifiability without_stopped(Identifiability found, const LogProblem& problem,
                                const std::vector<double>& coordinates);

}  // namespace awmr
