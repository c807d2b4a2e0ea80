/// Block-bootstrap intervals of a log fit. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "awmr/identify/logs/quantities.h"

namespace awmr {

struct BootstrapOptions {
  int resamples = 1000;
  std::uint64_t seed = 1;
};

/// Solution of a log fit with n quantities, its covariance (n x n), and the scores of the blocks
/// into which the logs are divided. A score is the gradient of -ln L, of length n.
struct BootstrapInput {
  const std::vector<FreeQuantity>& quantities;
  const std::vector<double>& coordinates;
  const Eigen::MatrixXd& covariance;
  const std::vector<Eigen::VectorXd>& scores;
};

/// Computes 95 % intervals by a block bootstrap. Each resample draws blocks with replacement and
/// makes one Gauss-Newton step from the solution. The steps are scaled so that their standard
/// deviations equal the standard errors of the covariance. The bootstrap thus determines only the
/// shape of the intervals, not their width. The ends are the 2.5 % and 97.5 % percentiles of each
/// quantity's value. Empty for 0 resamples.
std::vector<Interval> block_bootstrap(const BootstrapInput& input, const BootstrapOptions& options);

}  // namespace awmr
