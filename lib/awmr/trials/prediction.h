/// How well a model predicts a log from its commands.
#pragma once

#include <cstddef>
#include <vector>

#include "awmr/model/dynamics.h"
#include "awmr/trials/log.h"

namespace awmr {

/// How far predictions of one channel are from what was measured.
struct PredictionError {
  double nrmse = 0.0;  ///< root mean square error over the channel's own standard deviation
  double r2 = 0.0;     ///< 1 - sum of squared errors / sum of squares about the mean
  double rmse = 0.0;   ///< SI
};

/// Readings of a channel, and what the commands alone predict for them.
struct PredictedSeries {
  std::vector<double> t_s = {};        ///< rising
  std::vector<double> measured = {};   ///< SI
  std::vector<double> predicted = {};  ///< SI
};

struct ChannelPrediction {
  LogChannel channel = LogChannel::kX;
  int samples = 0;
  PredictionError one_step;      ///< from the last measured row to the next
  PredictionError long_horizon;  ///< by the commands alone over windows of `horizon_s`
  PredictedSeries series = {};   ///< the long horizon, as far as it was asked for
};

struct PredictionOptions {
  double horizon_s = 10.0;   ///< the length of a window, each from its own measured initial state
  double delay_s = 0.0;      ///< from a command to its effect
  double motor_lag_s = 0.0;  ///< the time constant of the motors, >= 0
  /// Of so many readings of a channel at most the series is kept, every n-th of them; 0: of none.
  std::size_t most_in_series = 0;
};

/// By channel, in the order of kChannels. A channel that does not vary (a log at rest) has no NRMSE
/// and is left out.
std::vector<ChannelPrediction> predict_log(const DrivingLog& log, const Plant<double>& plant,
                                           const PredictionOptions& options);

}  // namespace awmr
