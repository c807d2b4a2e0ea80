/// Residuals of one window of a log, and their derivatives. Private to identify/.
///
/// The model is simulated with the logged commands and compared with all measurements. Correlated
/// errors of a channel are whitened. The Jacobian has a row per sample; it is accumulated as J^T J,
/// so memory does not grow with the samples.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/logs/channel_noise.h"
#include "awmr/identify/logs/quantities.h"

namespace awmr {

/// Data shared by all windows: the plant, the free quantities and the noise.
struct LogModel {
  Vehicle vehicle;
  ParameterValues<double> held;  ///< all parameters; those among the quantities are overridden
  std::vector<FreeQuantity> quantities;
  std::vector<InitialComponent> initial;
  NoiseLevels noise;
  double row_spacing_s = 0.02;   ///< shortest row spacing of the logs
  double longest_step_s = 0.01;  ///< of the integration
};

/// The errors of a window's n samples.
struct WindowErrors {
  Eigen::VectorXd raw;           ///< n: model + bias - measured, SI
  Eigen::VectorXd standardised;  ///< n: whitened, divided by the standard deviation, and weighted
  bool finite = false;           ///< false if the simulation is not finite
};

/// The errors of one window. `coordinates`: by free quantity. `initial_state`: by free component.
WindowErrors errors_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                       const double* initial_state);

/// Sums over the rows of a window. The residuals r are the standardised errors and the prior of the
/// initial state at its measurement; J is their Jacobian. Columns: the q quantities, then the k
/// components of the initial state.
struct WindowSums {
  Eigen::MatrixXd products;  ///< (q + k + 1) square: [J r]^T [J r]
  /// Vectors of length q + k: J^T r of the samples of each block, without the prior; empty unless
  /// requested.
  std::vector<Eigen::VectorXd> block_gradients;
  bool finite = false;  ///< false if the simulation or its derivatives are not finite

  /// Half the sum of squares.
  double cost() const { return 0.5 * products(products.rows() - 1, products.rows() - 1); }
};

/// The sums of one window. With `block_s` > 0, also those of blocks of about this length.
WindowSums sums_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                   const double* initial_state, double block_s = 0.0);

}  // namespace awmr
