#include "awmr/validate/logs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "awmr/core/drawn_rows.h"
#include "awmr/core/option_text.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

/// The first row whose steering is not 0 or whose left and right forces differ.
std::optional<std::size_t> first_turning_row(const DrivingLog& log) {
  for (std::size_t row = 0; row < log.rows(); ++row) {
    const bool straight =
        log.driving_steering_rad()[row] == 0.0 && log.force_left[row] == log.force_right[row];
    if (!straight) return row;
  }
  return std::nullopt;
}

/// Copy of the log with only its commands and its speed, because a model of straight motion
/// predicts no other channel. Errors (input): the log turns, or has no speed.
Result<DrivingLog> straight_part(const DrivingLog& log, const Model& model) {
  if (const auto row = first_turning_row(log)) {
    Error error = model.plant().error();
    error.faults.insert(
        error.faults.begin(),
        Fault{
            ErrorCode::kUnsupported, fmt::format("{}:{}", log.file, log.line[*row]),
            "the vehicle turns from this row of the log on (steering, or different left and right "
            "forces), but the model covers straight motion only; give a log of straight driving, "
            "or record the trials named below"});
    return tl::unexpected(std::move(error));
  }
  if (!log[LogChannel::kSpeed]) {
    return input_error(ErrorCode::kMissing, log.file,
                       "has no speed_mps, the only channel that a model of straight motion "
                       "predicts; map its column with " +
                           option_text("column"));
  }
  DrivingLog part = log;
  for (const LogChannel channel : kChannels) {
    if (channel != LogChannel::kSpeed) part[channel].reset();
  }
  return part;
}

/// Limits of a predicted series: readings of a channel, and points kept for the chart.
constexpr std::size_t kMaxInSeries = 100000;
constexpr std::size_t kMaxDrawn = 1000;

PredictedSeries drawn(const PredictedSeries& all) {
  const std::vector<std::vector<double>> signals{all.measured, all.predicted};
  PredictedSeries some;
  for (const std::size_t row : drawn_rows(all.t_s, signals, kDrawnTolerance, kMaxDrawn)) {
    some.t_s.push_back(all.t_s[row]);
    some.measured.push_back(all.measured[row]);
    some.predicted.push_back(all.predicted[row]);
  }
  return some;
}

/// Error (input): the simulation of the log diverged, so some prediction errors are not finite.
Status check_finite(const LogValidation& validation) {
  for (const ChannelValidation& channel : validation.channels) {
    if (std::isfinite(channel.one_step.nrmse) && std::isfinite(channel.long_horizon.nrmse))
      continue;
    return input_error(
        ErrorCode::kDiverges, validation.file,
        fmt::format("the simulation of the model with the commands of this log diverges ({} is not "
                    "finite): the log is of another vehicle, or a column is mapped to the wrong "
                    "channel; check the mapping with awmr map",
                    channel.channel));
  }
  return {};
}

}  // namespace

LogValidation validate_log(const DrivingLog& log, const Plant<double>& plant, double horizon_s,
                           double tolerance, double motor_lag_s) {
  const double duration_s = log.t_s.back() - log.t_s.front();
  LogValidation validation{log.file, std::min(horizon_s, duration_s), {}, true};
  const PredictionOptions options{
      .horizon_s = horizon_s, .motor_lag_s = motor_lag_s, .most_in_series = kMaxInSeries};
  for (const ChannelPrediction& prediction : predict_log(log, plant, options)) {
    ChannelValidation entry{std::string(info(prediction.channel).name),
                            std::string(info(prediction.channel).unit),
                            prediction.samples,
                            prediction.one_step,
                            prediction.long_horizon,
                            drawn(prediction.series)};
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
  LogValidation validation = validate_log(part ? *part : log, plant, horizon_s, tolerance,
                                          model.vehicle.motor_time_constant_s.value_or(0.0));
  AWMR_RETURN_IF_ERROR(check_finite(validation));
  if (!validation.channels.empty()) return validation;
  return input_error(ErrorCode::kTooFewData, log.file,
                     fmt::format("no channel has readings that can be predicted within a horizon "
                                 "of {:g} s; give a longer {}",
                                 horizon_s, option_text("horizon")));
}

}  // namespace awmr
