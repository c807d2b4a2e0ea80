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
Eigen::MatrixXd information(const std::vector<WindowResiduals>& residuals, Eigen::Index n);

/// The scores (n: the projected Jacobian's rows times their residuals, summed) of blocks of about
/// `block_s` within each window, for the bootstrap.
std::vector<Eigen::VectorXd> block_scores(const std::vector<FitWindow>& windows,
                                          const std::vector<WindowResiduals>& residuals,
                                          Eigen::Index n, double block_s);

/// Long enough for the blocks to be nearly independent: five times the longest correlation.
double block_length_s(const NoiseLevels& noise);

/// -2 ln L + 2 n with the noise at its estimate; L of first-order processes:
///
///     AIC = 2 n + sum over the channels of  count ln(sigma^2 (1 - phi^2)),   phi = e^(-dt/tau)
double akaike(const NoiseLevels& noise, Eigen::Index n);

}  // namespace awmr
