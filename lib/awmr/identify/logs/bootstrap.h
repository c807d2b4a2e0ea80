/// Block-bootstrap intervals, which do not depend on the noise model. Private to identify/.
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

/// The solution with its covariance (n x n), and the scores (n) of blocks of the logs.
struct BootstrapInput {
  const std::vector<FreeQuantity>& quantities;
  const std::vector<double>& coordinates;
  const Eigen::MatrixXd& covariance;
  const std::vector<Eigen::VectorXd>& scores;
};

/// Block bootstrap: blocks drawn with replacement, one Gauss-Newton step from the solution for each
/// draw, scaled to the covariance's standard error; the 2.5 % and 97.5 % percentiles of every
/// quantity's value. The shape of the intervals need not be normal. Empty if no resamples are
/// requested.
std::vector<Interval> block_bootstrap(const BootstrapInput& input, const BootstrapOptions& options);

}  // namespace awmr
