/// Simulates a model with the commands of a driving log, and compares the predicted channels with
/// the measured ones.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/model/dynamics.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Prediction error of one channel.
struct PredictionError {
  double nrmse = 0.0;  ///< rmse divided by the standard deviation of the measurements
  double r2 = 0.0;     ///< 1 - sum of squared errors / sum of squares about the mean
  double rmse = 0.0;   ///< root mean square error, SI
};

/// Measurements of a channel over time, and their predictions.
struct PredictedSeries {
  std::vector<double> t_s = {};        ///< times of the measurements, rising
  std::vector<double> measured = {};   ///< SI
  std::vector<double> predicted = {};  ///< SI
};

struct ChannelPrediction {
  LogChannel channel = LogChannel::kX;
  int samples = 0;  ///< number of measurements
  /// Error if each row is predicted from the measurements of the row before.
  PredictionError one_step;
  /// Error if a whole window is predicted from its measured initial state.
  PredictionError long_horizon;
  PredictedSeries series = {};  ///< long-horizon prediction; empty if most_in_series is 0
};

struct PredictionOptions {
  double horizon_s = 10.0;   ///< maximum length of a window, s
  double motor_lag_s = 0.0;  ///< time constant of the motors, s, >= 0
  /// Maximum number of measurements in a series; of more measurements, the series has every n-th.
  /// 0: no series.
  std::size_t most_in_series = 0;
};

/// Returns the prediction errors by channel, in the order of kChannels. Omits channels with fewer
/// than two measurements and constant channels, whose standard deviation is 0.
std::vector<ChannelPrediction> predict_log(const DrivingLog& log, const Plant<double>& plant,
                                           const PredictionOptions& options);

}  // namespace awmr
