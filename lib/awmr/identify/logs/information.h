/// Information and scores of the logs at the solution. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/logs/residuals.h"

namespace awmr {

/// Information of the logs about the n coordinates, after elimination of the initial state of each
/// window. With the Jacobian's parts J_t by coordinate and J_s by initial state, and the gradients
/// g = J^T r:
///
///     H = J_t^T J_t - J_t^T J_s (J_s^T J_s)^-1 J_s^T J_t
///     S = g_t       - J_t^T J_s (J_s^T J_s)^-1 g_s
struct FitEvidence {
  Eigen::MatrixXd information;  ///< H, Fisher information: n x n, symmetric, positive semidefinite
  Eigen::VectorXd score;        ///< S
};
FitEvidence fit_evidence(const std::vector<WindowSums>& sums, Eigen::Index n);

/// Score vectors of length n, one per block b of a log: g_t - J_t^T J_s (J_s^T J_s)^-1 g_s with the
/// block's gradients g = J_b^T r_b. Their scatter gives the variance of the fit without a noise
/// model.
struct Scores {
  std::vector<Eigen::VectorXd> blocks;  ///< blocks of some seconds within a window
  std::vector<Eigen::VectorXd> logs;    ///< whole logs: the sums of their blocks
};

/// Scores of the blocks, and of whole logs as sums of their blocks.
Scores scores_of(const std::vector<FitWindow>& windows, const std::vector<WindowSums>& sums,
                 Eigen::Index n);

/// Block length for nearly independent blocks: five times the longest correlation, at most a
/// window.
double block_length_s(const NoiseLevels& noise);

/// AIC: -2 ln L + 2 (n + parameters of the noise), up to a constant of the logs.
double akaike(const NoiseLevels& noise, Eigen::Index n);

}  // namespace awmr
