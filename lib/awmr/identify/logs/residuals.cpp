#include "awmr/identify/logs/residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "awmr/core/index.h"
#include "awmr/identify/logs/linear_replay.h"
#include "awmr/identify/logs/product_sums.h"
#include "awmr/identify/logs/smoothed_channel.h"
#include "awmr/identify/logs/wheel_slip.h"
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
  std::array<double, kChannelCount> bias{};
  std::array<std::optional<std::size_t>, kChannelCount> bias_column{};
  std::array<std::optional<DelayColumn>, kChannelCount> sensor_delay{};
  std::array<std::optional<SensorFilter>, kChannelCount> sensor_lag{};
  std::vector<WheelSlip> slips;
  std::optional<OffsetColumn> sway_offset;
  std::optional<OffsetColumn> sway_angle;
  State<double> initial{};

  bool any_late() const {
    return std::ranges::any_of(sensor_delay, [](const auto& d) { return d.has_value(); });
  }
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
        u.sensor_lag[at(quantity.channel)] = {{number, i}, quantity.is_at_rows};
        break;
      case FreeQuantity::Kind::kSensorDelay:
        u.sensor_delay[at(quantity.channel)] = {number, i};
        if (quantity.channel == LogChannel::kX) u.sensor_delay[at(LogChannel::kY)] = {number, i};
        break;
      case FreeQuantity::Kind::kWheelSlip:
        u.slips.push_back({quantity.channel, {number, i}, quantity.is_ratio});
        break;
      case FreeQuantity::Kind::kSwayOffset:
        u.sway_offset = {number, i};
        break;
      case FreeQuantity::Kind::kSwayAngle:
        u.sway_angle = {number, i};
        break;
      case FreeQuantity::Kind::kBias:
        u.bias[at(quantity.channel)] = number;
        u.bias_column[at(quantity.channel)] = i;
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
    const auto& lag = u.sensor_lag[at(channel)];
    if (!lag) continue;
    smoothed[at(channel)].emplace(*lag, channel_of(window.measured, channel), columns);
  }
  return smoothed;
}

/// Readings of the sensors at the motion of one time, without latency, filter and bias.
class Sensors {
 public:
  Sensors(const FitWindow& window, const Unpacked& u, std::size_t columns)
      : signals_(*window.signals),
        u_(u),
        wheels_{u.plant, u.parameters, columns_of(u.path)},
        row_(columns) {}

  /// Returns the reading at the time t of the motion. row() then has its derivatives.
  double read(LogChannel c, const LinearMotion& motion, double t_s) {
    if (!row_.empty()) std::copy_n(motion.row(c, row_.size()), row_.size(), row_.begin());
    double value = channel_of(motion.state, c);
    for (const WheelSlip& slip : u_.slips) {
      if (slip.channel != c) continue;
      value += add_wheel_slip(slip, wheels_, command_at(signals_, t_s, u_.path), motion,
                              row_.size(), row_.data());
    }
    return c == LogChannel::kSway ? sway(motion) : value;
  }
  std::vector<double>& row() { return row_; }

 private:
  /// Reading of the sway sensor (sway_offset()).
  double sway(const LinearMotion& motion) {
    const State<double>& s = motion.state;
    const double x = u_.sway_offset ? u_.sway_offset->value : 0.0;
    const double angle = u_.sway_angle ? u_.sway_angle->value : 0.0;
    const double along = std::sin(angle);
    const double across = std::cos(angle);
    const std::size_t columns = row_.size();
    if (columns > 0 && (u_.sway_offset || u_.sway_angle)) {
      const double* const by_u = motion.row(LogChannel::kSpeed, columns);
      const double* const by_r = motion.row(LogChannel::kYawRate, columns);
      for (std::size_t c = 0; c < columns; ++c) {
        row_[c] = across * row_[c] - along * by_u[c] + x * by_r[c];
      }
      if (u_.sway_offset) row_[u_.sway_offset->column] += s.r_radps;
      if (u_.sway_angle) {
        row_[u_.sway_angle->column] -= along * s.v_mps + across * s.u_mps;
      }
    }
    return across * s.v_mps - along * s.u_mps + x * s.r_radps;
  }

  const LogSignals& signals_;
  const Unpacked& u_;
  SlippingWheels wheels_;
  std::vector<double> row_;
};

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

/// Calls visit(i, error, row) for every sample i in order. `error` is model + bias - measured,
/// `row` has its derivatives, one per column; the visitor may overwrite it. Empty without columns.
/// A sensor with latency is compared with the state one delay earlier, a filtered sensor with the
/// output of the filter.
template <class Visit>
void for_each_error(const LogModel& model, const FitWindow& window, const Unpacked& u,
                    std::size_t columns, Visit visit) {
  const DrivingLog& log = *window.rows.log;
  const std::vector<Sample>& samples = window.samples();
  const double h = model.longest_step_s;
  const CommandColumns command_columns = columns_of(u.path);
  LinearStepper stepper(u.plant, columns, u.parameters, command_columns, h, u.extra);
  LinearStepper back(u.plant, columns, u.parameters, command_columns, h, u.extra);
  const bool any_late = u.any_late();
  std::vector<LinearMotion> motions;  // one per row; kept only if a sensor has latency
  Sensors sensors(window, u, columns);
  std::size_t next = 0;
  SmoothedChannels smoothed = smoothed_channels(window, u, columns);
  const auto compare = [&](const LinearMotion& motion, double t_s, const Sample& sample) {
    const LogChannel c = sample.channel;
    const auto& smooth = smoothed[at(c)];
    const double shown = smooth ? smooth->value() : sensors.read(c, motion, t_s);
    if (smooth && columns > 0) sensors.row() = smooth->by_column();
    const double error = shown + u.bias[at(c)] - log[c]->value[sample.row];
    if (columns > 0 && u.bias_column[at(c)]) sensors.row()[*u.bias_column[at(c)]] += 1.0;
    visit(next, error, sensors.row());
  };
  replay_linear(*window.signals, window.rows.begin, window.rows.end, u.path, stepper, h,
                first_motion(model, u, columns), [&](std::size_t at_row, const LinearMotion& now) {
                  if (any_late) motions.push_back(now);
                  follow(log, at_row, at_row > window.rows.begin, now, sensors, smoothed);
                  for (; next < samples.size() && samples[next].row == at_row; ++next) {
                    const auto& latency = u.sensor_delay[at(samples[next].channel)];
                    if (!latency) {
                      compare(now, log.t_s[at_row], samples[next]);
                      continue;
                    }
                    compare(earlier_motion(*window.signals, window.rows.begin, motions, back,
                                           *latency, h, u.path),
                            log.t_s[at_row] - latency->delay_s, samples[next]);
                  }
                });
}

/// Residual of the weak prior of a component of the initial state, which is centred on its
/// measurement.
double pull(const InitialComponent& component, const FitWindow& window, double initial) {
  return (initial - channel_of(window.measured, component.channel)) / component.prior_std;
}

/// Whitening filters of one channel: one for the errors and one for each of their derivatives.
struct RowWhitener {
  RowWhitener(const ChannelNoise& noise, std::size_t columns)
      : gains(noise), states(noise.drift_std > 0.0 ? columns : 0) {}

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
