/// The residuals of one window of a log and their derivatives. Private to identify/.
///
/// The model is driven by the logged commands and compared with everything that was measured. Where
/// a channel's errors are correlated, they are whitened.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "awmr/identify/logs/channel_noise.h"
#include "awmr/identify/logs/quantities.h"

namespace awmr {

/// What all windows have in common: the plant, the free quantities and the noise.
struct LogModel {
  Vehicle vehicle;
  ParameterValues<double> held;  ///< all parameters; those among the quantities are overridden
  std::vector<FreeQuantity> quantities;
  std::vector<InitialComponent> initial;
  NoiseLevels noise;
  double longest_step_s = 0.01;  ///< of the integration
};

/// A window with n samples under q quantities and k components of the initial state.
struct WindowResiduals {
  Eigen::VectorXd raw;        ///< n: model + bias - measured, SI
  Eigen::VectorXd residuals;  ///< n + k: standardised, whitened and weighed; the pulls to measured
  /// (n + k) x (q + k): by coordinate, then by component; empty unless asked for.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian;
  bool finite = false;  ///< false where the model leaves the finite numbers
};

/// The residuals of one window, with their jacobian if asked for. `coordinates` has a number for each
/// free quantity, `initial_state` one for each free component.
WindowResiduals evaluate(const LogModel& model, const FitWindow& window, const double* coordinates,
                         const double* initial_state, bool with_jacobian);

}  // namespace awmr
