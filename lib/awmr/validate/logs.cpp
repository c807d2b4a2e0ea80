#include "awmr/validate/logs.h"

<<<<<<< HEAD
#include <utility>

namespace awmr {
=======
#include <array>
#include <cmath>

#include "awmr/model/rest.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

struct Sums {
  double one_step = 0.0;
  double long_horizon = 0.0;
  double mean = 0.0;
  double squares = 0.0;
  int count = 0;
};

PredictionError error_of(double squared_errors, const Sums& sums) {
  const double n = sums.count;
  const double mean = sums.mean / n;
  const double about_mean = sums.squares - n * mean * mean;
  return {std::sqrt(squared_errors / about_mean), 1.0 - squared_errors / about_mean,
          std::sqrt(squared_errors / n)};
}

State<double>& set(State<double>& state, LogChannel channel, double value) {
  switch (channel) {
    case LogChannel::kX:
      state.x_m = value;
      break;
    case LogChannel::kY:
      state.y_m = value;
      break;
    case LogChannel::kHeading:
      state.psi_rad = value;
      break;
    case LogChannel::kSpeed:
      state.u_mps = value;
      break;
    case LogChannel::kSway:
      state.v_mps = value;
      break;
    case LogChannel::kYawRate:
      state.r_radps = value;
      break;
    case LogChannel::kSteering:
      state.steering_rad = value;
      break;
  }
  return state;
}

class LogValidator {
 public:
  LogValidator(const DrivingLog& log, const Plant<double>& plant)
      : log_(log),
        signals_(log),
        plant_(resolved_at_rest(plant, replay_step_s(plant))),
        step_s_(replay_step_s(plant)) {}

  void add(const LogWindow& window) {
    replay<double>(signals_, window.begin, window.end, plant_, nullptr, step_s_,
                   measured_start(window), [&](std::size_t row, const State<double>& state) {
                     each_fresh(row, [&](LogChannel channel, double measured) {
                       Sums& sums = sums_[static_cast<std::size_t>(channel)];
                       const double error = channel_of(state, channel) - measured;
                       sums.long_horizon += error * error;
                       sums.mean += measured;
                       sums.squares += measured * measured;
                       ++sums.count;
                     });
                     if (row + 1 < window.end) one_step(row, state);
                   });
  }

  const std::array<Sums, kChannelCount>& sums() const { return sums_; }

 private:
  template <class Visit>
  void each_fresh(std::size_t row, Visit visit) const {
    for (const LogChannel channel : kChannels) {
      if (!log_[channel] || !log_[channel]->fresh[row]) continue;
      if (channel == LogChannel::kSteering && !log_.steering_command_rad) continue;
      visit(channel, log_[channel]->value[row]);
    }
  }

  /// What was measured in this row, the rest from the long run, one row on.
  void one_step(std::size_t row, State<double> state) {
    each_fresh(row, [&](LogChannel channel, double measured) { set(state, channel, measured); });
    replay<double>(signals_, row, row + 2, plant_, nullptr, step_s_, state,
                   [&](std::size_t at, const State<double>& next) {
                     if (at == row) return;
                     each_fresh(at, [&](LogChannel channel, double measured) {
                       const double error = channel_of(next, channel) - measured;
                       sums_[static_cast<std::size_t>(channel)].one_step += error * error;
                     });
                   });
  }

  const DrivingLog& log_;
  LogSignals signals_;
  Plant<double> plant_;
  double step_s_;
  std::array<Sums, kChannelCount> sums_{};
};

}  // namespace
>>>>>>> c4cc208 (Planning as functions from values to values; one home for the chord at rest and for gravity)

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
