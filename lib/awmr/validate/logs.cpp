#include "awmr/validate/logs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/drawn_rows.h"
#include "awmr/model/sliding.h"
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

/// Maximum number of measurements of a channel for which the prediction is kept; of more
/// measurements, every n-th.
constexpr std::size_t kMaxInSeries = 100000;
/// Maximum number of points in the chart of a channel.
constexpr std::size_t kMaxDrawn = 1000;

/// Sums over all measurements y of one channel.
struct LogSums {
  double one_step = 0.0;      ///< sum of squared errors of the one-step prediction
  double long_horizon = 0.0;  ///< sum of squared errors of the long-horizon prediction
  double measured = 0.0;      ///< sum of y
  double squares = 0.0;       ///< sum of y^2
  int count = 0;
  PredictedSeries series = {};
};
using ChannelSums = std::array<LogSums, kChannelCount>;

struct LogPredictor {
  LogSignals signals;
  Plant<double> plant;
  double step_s;
  std::optional<LaggedForces> lagged;
  std::size_t series_step;  ///< n: every n-th measurement is kept in the series
};

LogPredictor log_predictor(const DrivingLog& log, const Plant<double>& plant, double motor_lag_s) {
  const double step_s = replay_step_s(plant);
  std::optional<LaggedForces> lagged;
  if (motor_lag_s > 0.0) lagged.emplace(log, 0, log.rows(), motor_lag_s);
  return {LogSignals(log), resolved_beside_friction(plant, step_s), step_s, std::move(lagged),
          log.rows() / kMaxInSeries + 1};
}

template <class Visit>
void predict(const LogPredictor& model, std::size_t begin, std::size_t end,
             const State<double>& initial, Visit visit) {
  replay<double>(model.signals, begin, end, model.plant, nullptr, model.step_s, initial, visit,
                 model.lagged ? &*model.lagged : nullptr);
}

/// Predicts the next row from the measurements in `row`, and adds the squared errors to `sums`.
/// Components without a measurement in `row` come from `state`, the long-horizon prediction for
/// that row.
void add_one_step(const LogPredictor& model, std::size_t row, State<double> state,
                  ChannelSums& sums) {
  const DrivingLog& log = *model.signals.log;
  each_measurement(log, row, [&](LogChannel channel, double measured) {
    channel_of(state, channel) = measured;
  });
  predict(model, row, row + 2, state, [&](std::size_t reached, const State<double>& next) {
    if (reached == row) return;
    each_measurement(log, reached, [&](LogChannel channel, double measured) {
      const double error = channel_of(next, channel) - measured;
      sums[at(channel)].one_step += error * error;
    });
  });
}

/// Adds the errors of a prediction over the window from its measured initial state, and those of
/// the one-step predictions within it.
void add_window(const LogPredictor& model, const LogWindow& window, ChannelSums& sums) {
  predict(model, window.begin, window.end, measured_initial_state(window),
          [&](std::size_t row, const State<double>& state) {
            each_measurement(*window.log, row, [&](LogChannel channel, double measured) {
              LogSums& s = sums[at(channel)];
              const double predicted = channel_of(state, channel);
              if (static_cast<std::size_t>(s.count) % model.series_step == 0) {
                s.series.t_s.push_back(window.log->t_s[row]);
                s.series.measured.push_back(measured);
                s.series.predicted.push_back(predicted);
              }
              const double error = predicted - measured;
              s.long_horizon += error * error;
              s.measured += measured;
              s.squares += measured * measured;
              ++s.count;
            });
            if (row + 1 < window.end) add_one_step(model, row, state, sums);
          });
}

/// Sum of squares about the mean: sum y^2 - n (mean y)^2.
double about_mean(const LogSums& sums) {
  const double n = sums.count;
  const double mean = sums.measured / n;
  return sums.squares - n * mean * mean;
}

PredictionError error_of(double squared_errors, const LogSums& sums) {
  const double n = sums.count;
  return {std::sqrt(squared_errors / about_mean(sums)), 1.0 - squared_errors / about_mean(sums),
          std::sqrt(squared_errors / n)};
}

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
  const LogPredictor model = log_predictor(log, plant, motor_lag_s);
  ChannelSums sums{};
  for (const LogWindow& window : windows_of(log, horizon_s)) add_window(model, window, sums);
  for (const LogChannel channel : kChannels) {
    const LogSums& s = sums[at(channel)];
    if (s.count < 2 || !(about_mean(s) > 0.0)) continue;
    validation.channels.push_back({.channel = std::string(info(channel).name),
                                   .unit = std::string(info(channel).unit),
                                   .samples = s.count,
                                   .one_step = error_of(s.one_step, s),
                                   .long_horizon = error_of(s.long_horizon, s),
                                   .series = drawn(s.series)});
    validation.passed =
        validation.passed && validation.channels.back().long_horizon.nrmse <= tolerance;
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
