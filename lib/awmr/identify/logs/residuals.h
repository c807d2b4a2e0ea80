/// Residuals of one window of a log, and the derivatives that a search needs. Private to
/// identify/.
///
/// The model is driven by the logged commands and compared with everything that was measured. Where
/// a channel's errors are correlated, they are whitened. The Jacobian, which has a row for every
/// sample, is summed up as it is made: memory does not grow with it.
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
  double row_spacing_s = 0.02;   ///< the shortest of the logs'
  double longest_step_s = 0.01;  ///< of the integration
};

/// The errors of a window's n samples.
struct WindowErrors {
  Eigen::VectorXd raw;           ///< n: model + bias - measured, SI
  Eigen::VectorXd standardised;  ///< n: whitened, over their standard deviation, and weighed
  bool finite = false;           ///< false where the model leaves the finite numbers
};

/// The errors of one window. `coordinates` has a number for each free quantity, `initial_state` one
/// for each free component.
WindowErrors errors_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                       const double* initial_state);

/// A window's residuals r, the standardised errors and then the pulls of its initial state to what
/// was measured, and their Jacobian J, summed over all rows. Columns: the q quantities, then the k
/// components of the initial state.
struct WindowSums {
  Eigen::MatrixXd products;  ///< (q + k + 1) square: [J r]^T [J r]
  /// q + k each: J^T r of the samples of each block, without the pulls; none unless requested.
  std::vector<Eigen::VectorXd> block_gradients;
  bool finite = false;  ///< false where the model or its derivatives leave the finite numbers

  /// Half the sum of squares.
  double cost() const { return 0.5 * products(products.rows() - 1, products.rows() - 1); }
};

/// The sums of one window, with blocks of about `block_s` where that is above 0.
WindowSums sums_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                   const double* initial_state, double block_s = 0.0);

}  // namespace awmr
