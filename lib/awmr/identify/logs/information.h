/// What the logs say of the quantities at the solution. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/logs/residuals.h"

namespace awmr {

/// Fisher information on the n coordinates (n x n, symmetric, positive semidefinite), each window's
/// initial state eliminated. With the Jacobian's parts J_t by coordinate and J_s by initial state:
///
///     H = J_t^T J_t - J_t^T J_s (J_s^T J_s)^-1 J_s^T J_t
Eigen::MatrixXd information(const std::vector<WindowSums>& sums, Eigen::Index n);

/// The score J^T r of the n coordinates at the same initial states: g_t - J_t^T J_s (J_s^T J_s)^-1 g_s.
Eigen::VectorXd score(const std::vector<WindowSums>& sums, Eigen::Index n);

/// The scores of parts b of the logs (n: g_t - J_t^T J_s (J_s^T J_s)^-1 g_s of the gradients g = J_b^T r_b).
/// How they scatter tells how much the fit can be off, whatever the noise is.
struct Scores {
  std::vector<Eigen::VectorXd> blocks;  ///< of some seconds within a window
  std::vector<Eigen::VectorXd> logs;    ///< of whole logs: the sums of their blocks
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
