/// Which quantities the logs show, how well, and why not the others. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "awmr/identify/logs/information.h"
#include "awmr/identify/logs/log_problem.h"

namespace awmr {

/// A coordinate whose standard error is this share of its large change is not shown by the data: a
/// factor of 2.7 either way at 95 % for a logarithm, 1 for an exponent.
inline constexpr double kUnknown = 0.5;

struct Identifiability {
  /// n x n, of the coordinates. Non-identifiable coordinates have a large variance, which
  /// propagates to all correlated coordinates.
  Eigen::MatrixXd covariance;
  std::vector<double> degrees_of_freedom;  ///< of the standard errors, by quantity
  std::vector<std::string> why_not;        ///< by quantity; empty where the logs show it
  int rank = 0;                            ///< directions that the logs show
  double condition_number = 0.0;  ///< of the Jacobian, coordinates over their large changes
  /// By quantity: the factor on the standard error by which blocks of residuals scatter more than
  /// their noise model says; 1: they do not.
  std::vector<double> factor;

  double widened() const { return factor.empty() ? 1.0 : std::ranges::max(factor); }
};

/// The covariance from the information H (n x n) and, as a check of its noise model, the scores s_b
/// of m parts of the logs. With coordinates over their large changes and a weak prior P,
///
///     C = (H + P)^-1,   V = m/(m - 1) C (sum s_b s_b^T) C,   covariance = D C D,
///     D_ii^2 = max(1, V_ii / C_ii)
///
/// The parts are blocks; and whole logs where there are three or more and these scatter more than
/// chance would have them at 5 %, as they do where the model errs in every log in another way.
/// A quantity is refused where its standard error is half its large change or more, or where it has
/// a tenth or more of the squared length of a direction that the logs leave open.
Identifiability identifiability(const Eigen::MatrixXd& information, const Scores& scores,
                                const std::vector<FreeQuantity>& quantities);

/// Refuses a coordinate that the search left at an end of its range: it was stopped there, not
/// found. Coordinates correlated with it are refused too, and an exponent without its factor.
Identifiability without_stopped(Identifiability found, const LogProblem& problem,
                                const std::vector<double>& coordinates);

}  // namespace awmr
