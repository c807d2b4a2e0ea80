/// Fisher information and score vectors of a log fit at its solution. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/logs/problem/residuals.h"

namespace awmr {

/// Information H and score S of the n coordinates (values or logarithms of the fitted quantities),
/// after elimination of each window's initial state. r are the residuals of a window; J_t and J_s
/// are their Jacobians with respect to the coordinates and to the initial state. With g_t = J_t^T r
/// and g_s = J_s^T r, summed over the windows:
///
///     H = J_t^T J_t - J_t^T J_s (J_s^T J_s)^-1 J_s^T J_t
///     S = g_t       - J_t^T J_s (J_s^T J_s)^-1 g_s
struct FitEvidence {
  Eigen::MatrixXd information;  ///< H, Fisher information: n x n, symmetric, positive semidefinite
  Eigen::VectorXd score;        ///< S, of length n
};
FitEvidence fit_evidence(const std::vector<WindowSums>& sums, Eigen::Index n);

/// Score vectors S of length n (see FitEvidence) of parts of the logs. Their scatter gives the
/// variance of the estimates, even if the noise model is wrong.
struct Scores {
  std::vector<Eigen::VectorXd> blocks;  ///< blocks of some seconds within a window
  std::vector<Eigen::VectorXd> logs;    ///< whole logs: sums over their blocks
};

Scores scores_of(const std::vector<FitWindow>& windows, const std::vector<WindowSums>& sums,
                 Eigen::Index n);

/// Length, s, of the blocks into which a log is divided: five times the longest correlation time of
/// the noise, so that blocks are nearly independent, but at least 1 s and at most kWindow_s.
double block_length_s(const NoiseLevels& noise);

}  // namespace awmr
