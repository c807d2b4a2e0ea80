#include "awmr/validate/logs.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "awmr/trials/replay.h"

namespace awmr {
namespace {

/// The first row that steers, or drives the sides apart.
std::optional<std::size_t> first_turning_row(const DrivingLog& log) {
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const bool straight =
        log.driving_steering_rad()[row] == 0.0 && log.force_left[row] == log.force_right[row];
    if (!straight) return row;
  }
  return std::nullopt;
}

/// The log's commands and its speed, which is all that straight motion predicts.
/// Errors (input): the log turns; it has no speed.
Result<DrivingLog> straight_part(const DrivingLog& log, const Model& model) {
  if (const auto row = first_turning_row(log)) {
    Error error = model.plant().error();
    error.faults.insert(error.faults.begin(),
                        Fault{fmt::format("{}:{}", log.file, log.line[*row]),
                              "the log turns from here, and the model knows straight motion alone; "
                              "give a log that drives straight on, or the trials named below"});
    return tl::unexpected(std::move(error));
  }
  if (!log[LogChannel::kSpeed]) {
    return input_error(log.file,
                       "there is no speed_mps, and the model, which knows straight motion alone, "
                       "predicts nothing else; map the column");
  }
  DrivingLog part = log;
  for (const LogChannel channel : kChannels) {
    if (channel != LogChannel::kSpeed) part[channel].reset();
  }
  return part;
}

}  // namespace

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

Result<LogValidation> validate_log(const DrivingLog& log, const Model& model, double horizon_s,
                                   double tolerance) {
  const Motion motion = model.simulated_motion();
  AWMR_ASSIGN_OR_RETURN(const Plant<double> plant, model.plant(motion));
  AWMR_RETURN_IF_ERROR(check_replay(plant, model.file));
  std::optional<DrivingLog> part;
  if (motion != Motion::kPlanar) {
    AWMR_ASSIGN_OR_RETURN(part, straight_part(log, model));
  }
  LogValidation validation = validate_log(part ? *part : log, plant, horizon_s, tolerance);
  if (!validation.channels.empty()) return validation;
  return input_error(log.file, fmt::format("no channel has readings to be predicted within a "
                                           "horizon of {:g} s: give a longer one",
                                           horizon_s));
}

}  // namespace awmr
