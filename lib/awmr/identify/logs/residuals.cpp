#include "awmr/identify/logs/residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/logs/linear_replay.h"
#include "awmr/identify/logs/product_sums.h"
#include "awmr/identify/logs/sensors.h"
#include "awmr/identify/logs/whitener.h"
#include "awmr/model/sliding.h"

namespace awmr {
namespace {

/// Plant, command path, sensor errors and initial state at one point of the search, with the
/// columns of the free quantities.
struct Unpacked {
  Plant<double> plant;
  std::vector<ParameterColumn> parameters;
  CommandPath path;
  ExtraForces extra;
  SensorTerms sensors;
  State<double> initial{};
};

/// Raises a servo time constant below h/2 to h/2, which Runge-Kutta steps of h seconds resolve, and
/// drops its derivative. Otherwise a search for a time constant near 0 would end where the
/// integration diverges.
void slow_servo(double h, std::vector<ParameterColumn>& parameters, Plant<double>& plant) {
  if (!(plant.steering_time_constant_s < 0.5 * h)) return;
  plant.steering_time_constant_s = 0.5 * h;
  std::erase_if(parameters, [](const ParameterColumn& column) {
    return column.id == ParameterId::kSteeringTimeConstant;
  });
}

/// The smoothing of a channel with the variance `variance_s2`.
Smoothing smoothing_at(const LogModel& model, const FreeQuantity& quantity, double variance_s2,
                       std::size_t column) {
  const double rows2_per_s2 = std::pow(model.row_spacing_s, -2);
  const double variance = variance_s2 * rows2_per_s2;
  return {quantity.is_mean ? moving_average(variance) : gaussian_kernel(variance), column,
          rows2_per_s2};
}

Unpacked unpack(const LogModel& model, const FitWindow& window, const double* coordinates,
                const double* initial_state) {
  Unpacked u{};
  ParameterValues<double> values = model.held;
  for (std::size_t i = 0; i < model.quantities.size(); ++i) {
    const FreeQuantity& quantity = model.quantities[i];
    const double number = quantity.value(coordinates[i]);
    switch (quantity.kind) {
      case FreeQuantity::Kind::kParameter:
        values[at(quantity.id)] = number;
        u.parameters.push_back({quantity.id, i, quantity.jacobian(coordinates[i])});
        break;
      case FreeQuantity::Kind::kDelay:
        u.path.delay = {number, i};
        break;
      case FreeQuantity::Kind::kSteeringDelay:
        u.path.steering_delay = {number, i};
        break;
      case FreeQuantity::Kind::kMotorLag:
        u.path.lag.emplace(*window.rows.log, window.rows.begin, window.rows.end, number);
        u.path.lag_column = i;
        break;
      case FreeQuantity::Kind::kSteeringTrim:
        u.path.steering_trim = {number, i};
        break;
      case FreeQuantity::Kind::kServoRate:
        u.path.servo_rate = {number, i};
        break;
      case FreeQuantity::Kind::kForceImbalance:
        u.path.imbalance = {number, i};
        break;
      case FreeQuantity::Kind::kForceExponent:
        u.path.exponent = {number, i};
        break;
      case FreeQuantity::Kind::kForceSaturation:
        u.path.saturation = {number, i};
        u.path.full_command = quantity.full_command;
        break;
      case FreeQuantity::Kind::kSaturationSharpness:
        u.path.sharpness = {number, i};
        break;
      case FreeQuantity::Kind::kExtraForce:
        u.extra[quantity.force] = number;
        u.extra.columns.push_back({quantity.force, i, quantity.jacobian(coordinates[i])});
        break;
      case FreeQuantity::Kind::kSensorLag:
        u.sensors.lag[at(quantity.channel)] = {{number, i}, quantity.is_at_rows};
        break;
      case FreeQuantity::Kind::kSmoothing:
        u.sensors.smoothing[at(quantity.channel)] = smoothing_at(model, quantity, number, i);
        break;
      case FreeQuantity::Kind::kSensorDelay:
        u.sensors.delay[at(quantity.channel)] = {number, i};
        if (quantity.channel == LogChannel::kX) {
          u.sensors.delay[at(LogChannel::kY)] = {number, i};
        }
        break;
      case FreeQuantity::Kind::kWheelSlip:
        u.sensors.slips.push_back({quantity.channel, {number, i}, quantity.is_ratio});
        break;
      case FreeQuantity::Kind::kSwayOffset:
        u.sensors.sway_offset = {number, i};
        break;
      case FreeQuantity::Kind::kSwayAngle:
        u.sensors.sway_angle = {number, i};
        break;
      case FreeQuantity::Kind::kBias:
        u.sensors.bias[at(quantity.channel)] = number;
        u.sensors.bias_column[at(quantity.channel)] = i;
        break;
    }
  }
  const double given_lag_s = model.vehicle.motor_time_constant_s.value_or(0.0);
  if (!u.path.lag && given_lag_s > 0.0) {
    u.path.lag.emplace(*window.rows.log, window.rows.begin, window.rows.end, given_lag_s);
  }
  u.path.switches_off = values[at(ParameterId::kBackEmf)] > 0.0;
  u.plant = resolved_beside_friction(plant_of(model.vehicle, values), model.longest_step_s);
  if (u.path.servo_rate) u.plant.steering_max_rate_radps = u.path.servo_rate->value;
  slow_servo(model.longest_step_s, u.parameters, u.plant);
  // A logged steering angle is used directly, without servo limit or lag.
  if (!window.rows.log->steering_command_rad) u.plant.steering_max_rad = 10.0;
  u.initial = window.measured;
  for (std::size_t i = 0; i < model.initial.size(); ++i) {
    channel_of(u.initial, model.initial[i].channel) = initial_state[i];
  }
  if (u.path.steering_trim) u.initial.steering_rad += u.path.steering_trim->value;
  return u;
}

/// Initial motion of a window. The derivative of each free component of the state by itself is 1,
/// and so is that of the steering angle by its trim. The others are 0.
LinearMotion first_motion(const LogModel& model, const Unpacked& u, std::size_t columns) {
  LinearMotion motion{u.initial, std::vector<double>(kStateSize * columns, 0.0)};
  for (std::size_t i = 0; columns > 0 && i < model.initial.size(); ++i) {
    motion.row(model.initial[i].channel, columns)[model.quantities.size() + i] = 1.0;
  }
  if (u.path.steering_trim && columns > 0) {
    motion.row(LogChannel::kSteering, columns)[u.path.steering_trim->column] = 1.0;
  }
  return motion;
}

/// Simulated sensor filters of a window, one per channel; empty for channels without a filter.
using SmoothedChannels = std::array<std::optional<SmoothedChannel>, kChannelCount>;

SmoothedChannels smoothed_channels(const FitWindow& window, const Unpacked& u,
                                   std::size_t columns) {
  SmoothedChannels smoothed;
  for (const LogChannel channel : kChannels) {
    const auto& lag = u.sensors.lag[at(channel)];
    if (!lag) continue;
    smoothed[at(channel)].emplace(*lag, channel_of(window.measured, channel), columns);
  }
  return smoothed;
}

/// Passes the readings at a row of the log to the filters of smoothed channels. `has_before`: true
/// if the row is not the first of the window.
void follow(const DrivingLog& log, std::size_t row, bool has_before, const LinearMotion& now,
            Sensors& sensors, SmoothedChannels& smoothed) {
  const double since_s = has_before ? log.t_s[row] - log.t_s[row - 1] : 0.0;
  for (const LogChannel c : kChannels) {
    if (!smoothed[at(c)]) continue;
    const double input = sensors.read(c, now, log.t_s[row]);
    smoothed[at(c)]->next(input, sensors.row().data(), since_s, sensors.row().size());
  }
}

/// Readings of one channel at all rows of a window, with derivatives, and their smoothing.
class ReadingSeries {
 public:
  void add(double value, const std::vector<double>& row) {
    values_.push_back(value);
    rows_.insert(rows_.end(), row.begin(), row.end());
  }
  /// Returns the smoothed reading at the place i; `row` gets its derivatives. A pair of rows i - n
  /// and i + n of which one is outside of the window counts as twice the row i.
  double smoothed(std::size_t i, const Smoothing& smoothing, std::vector<double>& row) const {
    const auto& [weight, by_variance] = smoothing.kernel;
    double value = values_[i];
    double by = 0.0;
    const std::size_t columns = row.size();
    const double* const middle = rows_.data() + i * columns;
    std::copy_n(middle, columns, row.begin());
    const std::size_t reach = std::min({weight.size() - 1, i, values_.size() - 1 - i});
    for (std::size_t n = 1; n <= reach; ++n) {
      const double bend = values_[i - n] - 2.0 * values_[i] + values_[i + n];
      value += weight[n] * bend;
      by += by_variance[n] * bend;
      const double* const before = middle - n * columns;
      const double* const after = middle + n * columns;
      for (std::size_t k = 0; k < columns; ++k) {
        row[k] += weight[n] * (before[k] - 2.0 * middle[k] + after[k]);
      }
    }
    if (columns > 0) row[smoothing.column] += by * smoothing.rows2_per_s2;
    return value;
  }

 private:
  std::vector<double> values_;
  std::vector<double> rows_;  ///< [place][column]
};

/// Simulated readings of one window at the rows of its log, with derivatives.
class Readings {
 public:
  Readings(const LogModel& model, const FitWindow& window, const Unpacked& u, std::size_t columns)
      : model_(model),
        window_(window),
        u_(u),
        back_(u.plant, columns, u.parameters, columns_of(u.path), model.longest_step_s, u.extra),
        sensors_(*window.signals, u.sensors, u.path, u.plant, u.parameters, columns),
        filters_(smoothed_channels(window, u, columns)),
        is_kept_(u.sensors.any_delayed() || u.sensors.any_smoothed()),
        row_(columns) {}

  /// Adds the motion at the next row of the window.
  void add(const LinearMotion& now) {
    if (!is_kept_) return;
    motions_.push_back(now);
    const double t_s = window_.rows.log->t_s[window_.rows.begin + motions_.size() - 1];
    for (const LogChannel c : kChannels) {
      if (u_.sensors.smoothing[at(c)]) series_[at(c)].add(read_unsmoothed(c, t_s, now), row_);
    }
  }
  const std::vector<LinearMotion>& motions() const { return motions_; }
  /// Advances the filters to a row; call it for every row in order.
  void go_to(std::size_t row, const LinearMotion& now) {
    follow(*window_.rows.log, row, row > window_.rows.begin, now, sensors_, filters_);
  }
  /// Returns the reading of a channel at the row at which go_to() was called last. row() then has
  /// its derivatives. For a smoothed channel, the motions of all rows must have been added.
  double read(LogChannel c, std::size_t row, const LinearMotion& now) {
    if (const auto& smoothing = u_.sensors.smoothing[at(c)]) {
      return series_[at(c)].smoothed(row - window_.rows.begin, *smoothing, row_);
    }
    return read_unsmoothed(c, window_.rows.log->t_s[row], now);
  }
  std::vector<double>& row() { return row_; }

 private:
  double read_unsmoothed(LogChannel c, double t_s, const LinearMotion& now) {
    if (const auto& filter = filters_[at(c)]) {
      row_ = filter->by_column();
      return filter->value();
    }
    const auto& delay = u_.sensors.delay[at(c)];
    const double value =
        delay ? sensors_.read(c,
                              earlier_motion(*window_.signals, window_.rows.begin, motions_, back_,
                                             *delay, model_.longest_step_s, u_.path),
                              t_s - delay->delay_s)
              : sensors_.read(c, now, t_s);
    row_ = sensors_.row();
    return value;
  }

  const LogModel& model_;
  const FitWindow& window_;
  const Unpacked& u_;
  LinearStepper back_;
  Sensors sensors_;
  SmoothedChannels filters_;
  bool is_kept_;  ///< true: sensors read motions of other rows
  std::vector<LinearMotion> motions_;
  std::array<ReadingSeries, kChannelCount> series_;  ///< of smoothed channels
  std::vector<double> row_;
};

/// Calls visit(i, error, row) for every sample i in order. `error` is model + bias - measured,
/// `row` has its derivatives, one per column; the visitor may overwrite it. Empty without columns.
/// A sensor with latency is compared with the state one delay earlier, a filtered sensor with the
/// output of the filter, a smoothed channel with the mean over earlier and later rows.
template <class Visit>
void for_each_error(const LogModel& model, const FitWindow& window, const Unpacked& u,
                    std::size_t columns, Visit visit) {
  const DrivingLog& log = *window.rows.log;
  const std::vector<Sample>& samples = window.samples();
  const double h = model.longest_step_s;
  LinearStepper stepper(u.plant, columns, u.parameters, columns_of(u.path), h, u.extra);
  Readings readings(model, window, u, columns);
  std::size_t next = 0;
  const auto compare_at = [&](std::size_t row, const LinearMotion& now) {
    readings.go_to(row, now);
    for (; next < samples.size() && samples[next].row == row; ++next) {
      const LogChannel c = samples[next].channel;
      const double read = readings.read(c, row, now);
      const double error = read + u.sensors.bias[at(c)] - log[c]->value[row];
      const auto& bias_column = u.sensors.bias_column[at(c)];
      if (columns > 0 && bias_column) readings.row()[*bias_column] += 1.0;
      visit(next, error, readings.row());
    }
  };
  const bool waits = u.sensors.any_smoothed();  // for the rows after a row
  replay_linear(*window.signals, window.rows.begin, window.rows.end, u.path, stepper, h,
                first_motion(model, u, columns), [&](std::size_t row, const LinearMotion& now) {
                  readings.add(now);
                  if (!waits) compare_at(row, now);
                });
  for (std::size_t i = 0; waits && i < readings.motions().size(); ++i) {
    compare_at(window.rows.begin + i, readings.motions()[i]);
  }
}

/// Residual of the weak prior of a component of the initial state, which is centred on its
/// measurement.
double pull(const InitialComponent& component, const FitWindow& window, double initial) {
  return (initial - channel_of(window.measured, component.channel)) / component.prior_std;
}

/// Whitening filters of one channel: one for the errors and one for each of their derivatives.
struct RowWhitener {
  RowWhitener(const ChannelNoise& noise, std::size_t columns)
      : gains(noise), states(noise.is_white() ? 0 : columns) {}

  /// Replaces each number of the row by weight times its innovation over the standard deviation.
  void next(double since_s, double weight, std::vector<double>& row) {
    const WhitenerGains::Step& step = gains.next(since_s);
    const double scale = weight / std::sqrt(step.variance);
    for (std::size_t c = 0; c < states.size(); ++c) row[c] = states[c].next(row[c], gains, step);
    for (double& x : row) x *= scale;
  }

  WhitenerGains gains;
  std::vector<WhitenerState> states;
};

/// Divides a window's samples into blocks of about `block_s` seconds.
class Blocks {
 public:
  Blocks(const FitWindow& window, double block_s)
      : t_s_(window.rows.log->t_s), from_s_(t_s_[window.rows.begin]), block_s_(block_s) {}
  bool ends_before(const Sample& sample) {
    if (!(block_s_ > 0.0) || t_s_[sample.row] - from_s_ < block_s_) return false;
    from_s_ = t_s_[sample.row];
    return true;
  }

 private:
  const std::vector<double>& t_s_;
  double from_s_;
  double block_s_;
};

}  // namespace

WindowErrors errors_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                       const double* initial_state) {
  const std::vector<Sample>& samples = window.samples();
  WindowErrors result;
  result.raw.resize(rows_of(samples));
  result.standardised.resize(rows_of(samples));
  std::array<std::optional<Whitener>, kChannelCount> whiteners;
  for_each_error(model, window, unpack(model, window, coordinates, initial_state), 0,
                 [&](std::size_t i, double error, const std::vector<double>&) {
                   auto& whitener = whiteners[at(samples[i].channel)];
                   if (!whitener) whitener.emplace(model.noise.at(samples[i].channel));
                   const auto [value, variance] = whitener->next(error, samples[i].since_s);
                   result.raw(eigen_index(i)) = error;
                   result.standardised(eigen_index(i)) =
                       window.weight(i) / std::sqrt(variance) * value;
                 });
  result.finite = result.standardised.allFinite();
  return result;
}

WindowSums sums_of(const LogModel& model, const FitWindow& window, const double* coordinates,
                   const double* initial_state, double block_s) {
  const std::size_t q = model.quantities.size();
  const std::size_t k = model.initial.size();
  const std::vector<Sample>& samples = window.samples();
  ProductSums sums(q + k + 1);
  Blocks blocks(window, block_s);
  WindowSums result;
  std::array<std::optional<RowWhitener>, kChannelCount> whiteners;
  for_each_error(model, window, unpack(model, window, coordinates, initial_state), sums.columns(),
                 [&](std::size_t i, double error, std::vector<double>& row) {
                   const Sample& sample = samples[i];
                   if (blocks.ends_before(sample)) {
                     result.block_gradients.push_back(sums.take_gradient());
                   }
                   auto& whitener = whiteners[at(sample.channel)];
                   if (!whitener) {
                     whitener.emplace(model.noise.at(sample.channel), sums.columns());
                   }
                   row[q + k] = error;
                   whitener->next(sample.since_s, window.weight(i), row);
                   sums.add(row.data());
                 });
  if (block_s > 0.0) result.block_gradients.push_back(sums.take_gradient());
  for (std::size_t i = 0; i < k; ++i) {
    std::vector<double> row(sums.columns(), 0.0);
    row[q + i] = 1.0 / model.initial[i].prior_std;
    row[q + k] = pull(model.initial[i], window, initial_state[i]);
    sums.add(row.data());
  }
  result.products = sums.products();
  result.finite = result.products.allFinite();
  return result;
}

}  // namespace awmr
