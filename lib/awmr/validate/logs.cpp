#include "awmr/validate/logs.h"

#include <utility>

namespace awmr {

LogValidation validate_log(const DrivingLog& log, const Plant<double>& plant, double horizon_s,
                           double tolerance) {
  LogValidation validation{log.file, horizon_s, {}, true};
  for (const ChannelPrediction& prediction : predict_log(log, plant, {.horizon_s = horizon_s})) {
    ChannelValidation entry{std::string(info(prediction.channel).name),
                            std::string(info(prediction.channel).unit), prediction.samples,
                            prediction.one_step, prediction.long_horizon};
    validation.passed = validation.passed && entry.long_horizon.nrmse <= tolerance;
    validation.channels.push_back(std::move(entry));
  }
  validation.passed = validation.passed && !validation.channels.empty();
  return validation;
}

}  // namespace awmr
