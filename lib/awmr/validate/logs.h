/// Validation of a model on driving logs: prediction errors of each channel. Use logs that the
/// model was not fitted to.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"
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

/// Prediction errors of one channel of a log.
struct ChannelValidation {
  std::string channel;  ///< name: "yaw_rate_radps"
  std::string unit;
  int samples = 0;
  PredictionError one_step;  ///< errors of the prediction from each measured row to the next
  /// Errors of the prediction over windows of up to LogValidation::horizon_s. Each window starts
  /// from a measured state.
  PredictionError long_horizon;
  PredictedSeries series = {};  ///< long-horizon prediction, reduced to the points for a chart
};

/// Result of validate_log().
struct LogValidation {
  std::string file;
  double horizon_s = 0.0;  ///< maximum length of a window, s, at most the log's length
  std::vector<ChannelValidation> channels;
  /// True if there is at least one channel, and the long-horizon NRMSE of every channel is within
  /// the tolerance.
  bool passed = false;
};

/// Predicts the channels of the log from its commands. A channel is accepted if its long-horizon
/// NRMSE (RMS error divided by the standard deviation of the measurements) is at most `tolerance`.
/// A channel that does not vary (a vehicle at rest) has no NRMSE and is left out. `motor_lag_s`:
/// time constant of the motors, s, >= 0.
LogValidation validate_log(const DrivingLog& log, const Plant<double>& plant, double horizon_s,
                           double tolerance, double motor_lag_s = 0.0);

/// Same as validate_log() above, but for a model that may lack parameters. A model with only the
/// parameters of straight motion (Model::simulated_motion()) predicts the speed of a log that
/// drives straight. Errors (input): g1 or m' is missing; a time constant of the model is too short
/// for a simulation, or the simulation diverges; no channel can be predicted within the horizon.
/// For a model of straight motion also: the log turns (the message names the row and the missing
/// parameters), or has no speed_mps.
Result<LogValidation> validate_log(const DrivingLog& log, const Model& model, double horizon_s,
                                   double tolerance);

}  // namespace awmr
