/// Errors of a model's prediction of a log from its commands.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/model/dynamics.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Prediction error of one channel.
struct PredictionError {
  double nrmse = 0.0;  ///< root mean square error divided by the channel's standard deviation
  double r2 = 0.0;     ///< 1 - sum of squared errors / sum of squares about the mean
  double rmse = 0.0;   ///< SI
};

/// Readings of a channel and their predictions from the commands.
struct PredictedSeries {
  std::vector<double> t_s = {};        ///< rising
  std::vector<double> measured = {};   ///< SI
  std::vector<double> predicted = {};  ///< SI
};

struct ChannelPrediction {
  LogChannel channel = LogChannel::kX;
  int samples = 0;
  PredictionError one_step;      ///< from one measured row to the next
  PredictionError long_horizon;  ///< from the commands alone, over windows of `horizon_s`
  PredictedSeries series = {};   ///< long-horizon series, if requested
};

struct PredictionOptions {
  double horizon_s = 10.0;   ///< the length of a window, each from its own measured initial state
  double delay_s = 0.0;      ///< from a command to its effect
  double motor_lag_s = 0.0;  ///< the time constant of the motors, >= 0
  /// Maximum number of readings of a channel in its series, of which every n-th is kept; 0: no
  /// series.
  std::size_t most_in_series = 0;
};

/// Errors by channel, in the order of kChannels. A constant channel (a log at rest) has no NRMSE
/// and is omitted.
std::vector<ChannelPrediction> predict_log(const DrivingLog& log, const Plant<double>& plant,
                                           const PredictionOptions& options);

}  // namespace awmr
