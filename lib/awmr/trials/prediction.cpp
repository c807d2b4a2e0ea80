#include "awmr/trials/prediction.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/model/sliding.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

/// Sums over all measurements y of one channel.
struct Sums {
  double one_step = 0.0;      ///< sum of squared errors of the one-step prediction
  double long_horizon = 0.0;  ///< sum of squared errors of the long-horizon prediction
  double measured = 0.0;      ///< sum of y
  double squares = 0.0;       ///< sum of y^2
  int count = 0;
  PredictedSeries series = {};
};
using ChannelSums = std::array<Sums, kChannelCount>;

struct Predictor {
  LogSignals signals;
  Plant<double> plant;
  double step_s;
  std::optional<LaggedForces> lagged;
  std::size_t series_step;  ///< n: every n-th measurement is kept in the series; 0: no series
};

Predictor predictor(const DrivingLog& log, const Plant<double>& plant,
                    const PredictionOptions& options) {
  const double step_s = replay_step_s(plant);
  const std::size_t most = options.most_in_series;
  std::optional<LaggedForces> lagged;
  if (options.motor_lag_s > 0.0) lagged.emplace(log, 0, log.rows(), options.motor_lag_s);
  return {LogSignals(log), resolved_beside_friction(plant, step_s), step_s, std::move(lagged),
          most > 0 ? log.rows() / most + 1 : 0};
}

template <class Visit>
void run(const Predictor& model, std::size_t begin, std::size_t end, const State<double>& initial,
         Visit visit) {
  replay<double>(model.signals, begin, end, model.plant, nullptr, model.step_s, initial, visit,
                 model.lagged ? &*model.lagged : nullptr);
}

/// Predicts the next row from the measurements in `row`, and adds the squared errors to `sums`.
/// Components without a measurement in `row` come from `state`, the long-horizon prediction for
/// that row.
void add_one_step(const Predictor& model, std::size_t row, State<double> state, ChannelSums& sums) {
  const DrivingLog& log = *model.signals.log;
  each_measurement(log, row, [&](LogChannel channel, double measured) {
    channel_of(state, channel) = measured;
  });
  run(model, row, row + 2, state, [&](std::size_t reached, const State<double>& next) {
    if (reached == row) return;
    each_measurement(log, reached, [&](LogChannel channel, double measured) {
      const double error = channel_of(next, channel) - measured;
      sums[at(channel)].one_step += error * error;
    });
  });
}

void add_to_series(const Predictor& model, double t_s, double measured, double predicted, Sums& s) {
  if (model.series_step == 0 || static_cast<std::size_t>(s.count) % model.series_step != 0) return;
  s.series.t_s.push_back(t_s);
  s.series.measured.push_back(measured);
  s.series.predicted.push_back(predicted);
}

void add_window(const Predictor& model, const LogWindow& window, ChannelSums& sums) {
  run(model, window.begin, window.end, measured_initial_state(window),
      [&](std::size_t row, const State<double>& state) {
        each_measurement(*window.log, row, [&](LogChannel channel, double measured) {
          Sums& s = sums[at(channel)];
          const double predicted = channel_of(state, channel);
          add_to_series(model, window.log->t_s[row], measured, predicted, s);
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
double about_mean(const Sums& sums) {
  const double n = sums.count;
  const double mean = sums.measured / n;
  return sums.squares - n * mean * mean;
}

PredictionError error_of(double squared_errors, const Sums& sums) {
  const double n = sums.count;
  return {std::sqrt(squared_errors / about_mean(sums)), 1.0 - squared_errors / about_mean(sums),
          std::sqrt(squared_errors / n)};
}

}  // namespace

std::vector<ChannelPrediction> predict_log(const DrivingLog& log, const Plant<double>& plant,
                                           const PredictionOptions& options) {
  const Predictor model = predictor(log, plant, options);
  ChannelSums sums{};
  for (const LogWindow& window : windows_of(log, options.horizon_s)) {
    add_window(model, window, sums);
  }
  std::vector<ChannelPrediction> predictions;
  for (const LogChannel channel : kChannels) {
    Sums& s = sums[at(channel)];
    if (s.count < 2 || !(about_mean(s) > 0.0)) continue;
    predictions.push_back({channel, s.count, error_of(s.one_step, s), error_of(s.long_horizon, s),
                           std::move(s.series)});
  }
  return predictions;
}

}  // namespace awmr
