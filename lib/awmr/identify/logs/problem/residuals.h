/// Residuals of one window (about 10 s of a log, with its own initial state), and their derivatives
/// with respect to the unknowns of the fit. Private to identify/.
///
/// Simulates the model with the logged commands and compares it with all measurements. If the
/// errors of a channel are correlated in time, a filter makes them independent (whitening). The
/// Jacobian J has a row per sample, but only J^T J is stored. (If a channel is smoothed, also the
/// readings of a window and their derivatives are stored.)
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/logs/simulation/simulated_vehicle.h"

namespace awmr {

/// Errors of a window's n samples.
struct WindowErrors {
  Eigen::VectorXd raw;  ///< the n errors, model + bias - measured, SI
  /// The n errors, whitened, divided by their standard deviation and weighted.
  Eigen::VectorXd standardised;
  /// Part of -2 ln L that is due to uncertain times of command changes (marginalised()). The errors
  /// are those at the likeliest times.
  double change_cost = 0.0;
  /// Likeliest time of each of these changes minus its expected time, in standard deviations of the
  /// prior of this time.
  Eigen::VectorXd change_times;
  bool finite = false;  ///< false if the simulation is not finite
};

/// Simulates one window and returns its errors. `coordinates`: one per free quantity.
/// `initial_state`: one value per free component of the initial state.
WindowErrors errors_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                       const double* initial_state);

/// Sums over the residuals r of one window and their Jacobian J. The residuals are the standardised
/// errors of the samples, and those of a weak prior about the measured initial state. J has a
/// column for each of the q free quantities, then for each of the k free components of the initial
/// state. Uncertain times of command changes are eliminated (marginalised()).
struct WindowSums {
  Eigen::MatrixXd products;  ///< [J r]^T [J r], (q + k + 1) x (q + k + 1)
  /// J^T r (length q + k) of each block of samples, without the prior. Empty unless requested.
  std::vector<Eigen::VectorXd> block_gradients;
  /// `products` if the commands changed exactly at the times of their rows. Empty if no change has
  /// an uncertain time.
  Eigen::MatrixXd products_at_known_times;
  double change_cost = 0.0;  ///< ln det of marginalised()
  /// One row for each of the m changes at uncertain times: [m][q + k + 1]. The last column has the
  /// likeliest times (WindowErrors::change_times). Each column before it has the amounts by which
  /// these times decrease if one unknown (quantity or initial state) increases by 1.
  Eigen::MatrixXd change_times;
  bool finite = false;  ///< false if a number of the simulation or of J is not finite

  /// Half of r^T r.
  double cost() const { return 0.5 * products(products.rows() - 1, products.rows() - 1); }
};

/// Computes the sums of one window. If `block_s` > 0, also computes `block_gradients`, for blocks
/// of about `block_s` seconds.
WindowSums sums_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                   const double* initial_state, double block_s = 0.0);

}  // namespace awmr
