/// Validates the model on driving logs, preferably logs that were not fitted.
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
  PredictionError one_step;      ///< from one measured row to the next
  PredictionError long_horizon;  ///< from the commands alone over windows of `horizon_s`
  PredictedSeries series = {};   ///< long horizon, reduced to the readings for a chart
};

struct LogValidation {
  std::string file;
  double horizon_s = 0.0;
  std::vector<ChannelValidation> channels;
  bool passed = false;  ///< the long-horizon NRMSE of every channel is within the tolerance
};

/// A channel that does not vary (a log at rest) has no NRMSE and is left out. `motor_lag_s`: the time
/// constant of the motors.
LogValidation validate_log(const DrivingLog& log, const Plant<double>& plant, double horizon_s,
                           double tolerance, double motor_lag_s = 0.0);

/// As above, for a model that can be incomplete. If it has only straight motion (simulated_motion()
/// of model/model.h), the log must drive straight, and its speed is predicted.
/// Errors (input): the replay diverges; g1 or m' is missing; the log turns or has no speed_mps, and
/// the model has only straight motion. The message says where the log turns and which parameters
/// are missing.
Result<LogValidation> validate_log(const DrivingLog& log, const Model& model, double horizon_s,
                                   double tolerance);

}  // namespace awmr
