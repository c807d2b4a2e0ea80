/// The residuals of one window of a log and their derivatives. Private to identify/.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <vector>

#include "awmr/identify/logs/log_fit.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// A component of the initial state that is free in every window.
struct StartComponent {
  double State<double>::*member;
  double prior_std;  ///< of a weak pull to its measured or assumed start, SI
};

/// One measured value: where it stands, and how it is weighed.
struct Sample {
  std::size_t row;
  LogChannel channel;
  double weight = 1.0;   ///< sqrt of a robust loss's weight
  double since_s = 0.0;  ///< to the window's previous sample of this channel; 0: the first
};

/// A window with its samples and, after an evaluation, their residuals.
struct FitWindow {
  LogWindow window;
  const LogSignals* signals = nullptr;
  std::vector<Sample> samples;
  State<double> assumed{};    ///< the start that the prior pulls to
  double* start = nullptr;    ///< by StartComponent: the free numbers, owned by the fit
  Eigen::VectorXd raw;        ///< model + bias - measured, SI
  Eigen::VectorXd residuals;  ///< standardised, whitened, weighed; then one per StartComponent
  /// Row-major, columns: quantities, then start components.
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian;
};

/// What every window shares.
struct LogModel {
  Vehicle vehicle;
  std::map<ParameterId, double> held;  ///< all parameters; free ones overridden
  std::vector<FreeQuantity> quantities;
  std::vector<StartComponent> start;
  std::map<LogChannel, ChannelNoise> noise;
  double longest_step_s = 0.01;
};

/// Fills residuals, and the Jacobian where asked. False where the model leaves the finite numbers.
bool evaluate(const LogModel& model, const double* coordinates, bool with_jacobian,
              FitWindow& window);

}  // namespace awmr
