/// The model against driving logs, best those that it was not fitted to.
#pragma once

#include <string>
#include <vector>

#include "awmr/trials/prediction.h"

namespace awmr {

struct ChannelValidation {
  std::string channel;  ///< "yaw_rate_radps"
  std::string unit;
  int samples = 0;
  PredictionError one_step;      ///< from the last measured row to the next
  PredictionError long_horizon;  ///< by the commands alone over windows of `horizon_s`
};

struct LogValidation {
  std::string file;
  double horizon_s = 0.0;
  std::vector<ChannelValidation> channels;
  bool passed = false;  ///< every channel's long-horizon NRMSE within the tolerance
};

/// A channel that does not vary (a log at rest) has no NRMSE and is left out.
LogValidation validate_log(const DrivingLog& log, const Plant<double>& plant, double horizon_s,
                           double tolerance);

}  // namespace awmr
