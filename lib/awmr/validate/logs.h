/// The model against driving logs, best those that it was not fitted to.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/trials/prediction.h"

namespace awmr {

struct ChannelValidation {
  std::string channel;  ///< "yaw_rate_radps"
  std::string unit;
  int samples = 0;
  PredictionError one_step;      ///< from the last measured row to the next
  PredictionError long_horizon;  ///< by the commands alone over windows of `horizon_s`
  PredictedSeries series = {};   ///< as many readings of the long horizon as a chart needs
};

struct LogValidation {
  std::string file;
  double horizon_s = 0.0;
  std::vector<ChannelValidation> channels;
  bool passed = false;  ///< every channel's long-horizon NRMSE within the tolerance
};

/// A channel that does not vary (a log at rest) has no NRMSE and is left out. `motor_lag_s`: the time
/// constant of the motors.
LogValidation validate_log(const DrivingLog& log, const Plant<double>& plant, double horizon_s,
                           double tolerance, double motor_lag_s = 0.0);

/// The same with what the model knows. Where that is straight motion alone (simulated_motion() of
/// model/model.h), the log has to drive straight on, and its speed is predicted.
/// Errors (input): the replay diverges; g1 or m' is missing; the log turns, or has no speed_mps, and the model knows
/// straight motion alone: where it turns, and what is missing by name.
Result<LogValidation> validate_log(const DrivingLog& log, const Model& model, double horizon_s,
                                   double tolerance);

}  // namespace awmr
