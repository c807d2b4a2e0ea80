/// Information and scores of the logs at the solution. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/logs/residuals.h"

namespace awmr {

/// Evidence of the logs about the n coordinates, each window's initial state eliminated. With the
/// Jacobian's parts J_t by coordinate and J_s by initial state, and the gradients g = J^T r:
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

/// The scores of the blocks that were summed up, and of the logs that they make.
Scores scores_of(const std::vector<FitWindow>& windows, const std::vector<WindowSums>& sums,
                 Eigen::Index n);

/// Long enough for the blocks to be nearly independent: five times the longest correlation, within
/// a window.
double block_length_s(const NoiseLevels& noise);

/// Akaike's criterion, -2 ln L + 2 (n + numbers of the noise), but for a constant of the logs.
double akaike(const NoiseLevels& noise, Eigen::Index n);

}  // namespace awmr
