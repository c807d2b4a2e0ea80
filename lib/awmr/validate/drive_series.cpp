#include "awmr/validate/drive_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "awmr/core/index.h"
#include "awmr/core/option_text.h"
#include "awmr/core/statistics/sample_quantile.h"
#include "awmr/core/units.h"
#include "awmr/trials/log_start.h"
#include "awmr/trials/replay.h"

namespace awmr {
namespace {

/// Standard deviation sigma of white noise in the values x_k, estimated from second differences, on
/// which smooth motion has hardly any effect:
///   Var(x_(k+1) - 2 x_k + x_(k-1)) = 6 sigma^2
/// The variance is estimated by the median absolute deviation, which ignores outliers. The result
/// is at least q/sqrt(12), the error of rounding to the quantisation step q = `quantum`. Fewer than
/// 10 values give q/sqrt(12).
double white_noise(const std::vector<double>& values, double quantum) {
  const double least = quantum / std::sqrt(12.0);
  if (values.size() < 10) return least;
  std::vector<double> second;
  for (std::size_t k = 1; k + 1 < values.size(); ++k) {
    second.push_back(values[k + 1] - 2.0 * values[k] + values[k - 1]);
  }
  const double spread = kStdPerMad * median_absolute_deviation(second, median(second));
  return std::max(least, spread / std::sqrt(6.0));
}

/// A sensor of the controller, as pointers to members: the sensor's errors in a scenario's Sensors,
/// and its reading in a run's Measurement.
struct ControllersSensor {
  Channel Sensors::*errors;
  double Measurement<double>::*reading;
};
std::optional<ControllersSensor> sensor_of(LogChannel channel) {
  switch (channel) {
    case LogChannel::kHeading:
      return ControllersSensor{&Sensors::heading, &Measurement<double>::psi_rad};
    case LogChannel::kYawRate:
      return ControllersSensor{&Sensors::yaw_rate, &Measurement<double>::r_radps};
    case LogChannel::kSpeed:
      return ControllersSensor{&Sensors::speed, &Measurement<double>::u_mps};
    default:
      return std::nullopt;
  }
}

std::size_t window_of(double t_s) {
  return static_cast<std::size_t>(std::floor(t_s / kWindow_s + 1e-9));
}

/// Value of the channel in the row of the run that is nearest to the time t_s; after the end of the
/// run, in the last row.
double at_time(const DriveChannel& channel, const Run& run, double sample_time_s, double t_s) {
  const auto row = static_cast<std::size_t>(t_s / sample_time_s + 0.5);
  return channel.of_run(run.rows[std::min(row, run.rows.size() - 1)]);
}

template <class Value>
WindowMeans means(const DriveChannel& channel, double duration_s, const Value& value) {
  WindowMeans windows;
  windows.mean.resize(window_of(duration_s));
  windows.rows.resize(windows.mean.size());
  for (std::size_t i = 0; i < channel.t_s.size(); ++i) {
    const std::size_t window = window_of(channel.t_s[i]);
    if (window >= windows.mean.size()) break;
    windows.mean[window] += value(i);
    ++windows.rows[window];
  }
  for (std::size_t w = 0; w < windows.mean.size(); ++w) {
    if (windows.rows[w] > 0) windows.mean[w] /= windows.rows[w];
  }
  return windows;
}

/// Adds the rows from `first` on, over duration_s, for which `counts(row)` is true.
template <class Counts, class Value>
void take_rows(const DrivingLog& log, std::size_t first, double duration_s, const Counts& counts,
               const Value& value, DriveChannel& channel) {
  for (std::size_t row = first; row < log.rows(); ++row) {
    const double t_s = log.t_s[row] - log.t_s[first];
    if (t_s > duration_s) break;
    if (!counts(row)) continue;
    channel.t_s.push_back(t_s);
    channel.measured.push_back(value(row));
  }
}

/// Estimates the standard deviation of the noise in a channel's readings from row `first` on. The
/// noise is assumed to be white. Precondition: the log has the channel.
double noise_in(const DrivingLog& log, LogChannel which, std::size_t first) {
  std::vector<double> values;
  for (std::size_t row = first; row < log.rows(); ++row) {
    if (log[which]->fresh[row]) values.push_back(log[which]->value[row]);
  }
  return white_noise(values, log[which]->quantum);
}

DriveChannel measured_channel(const DrivingLog& log, LogChannel which, std::size_t first,
                              double duration_s, const Scenario& scenario) {
  const Measured& readings = *log[which];
  DriveChannel channel{
      .name = std::string(info(which).name),
      .unit = std::string(info(which).unit),
      .of_run = [which](const RunRow& row) { return channel_of(row.state, which); },
      .t_s = {},
      .measured = {}};
  take_rows(
      log, first, duration_s, [&](std::size_t row) { return readings.fresh[row]; },
      [&](std::size_t row) { return readings.value[row]; }, channel);
  if (const auto sensor = sensor_of(which)) {
    channel.of_run = [read = sensor->reading](const RunRow& row) { return row.measured.*read; };
    const Channel& errors = *scenario.sensors.*(sensor->errors);
    channel.noise = std::hypot(errors.noise, errors.quantum / std::sqrt(12.0));
    channel.noise_in_run = channel.noise > 0.0;
  }
  channel.noise_from_log = !channel.noise_in_run;
  if (channel.noise_from_log) channel.noise = noise_in(log, which, first);
  return channel;
}

}  // namespace

Result<std::size_t> first_row_of(const DrivingLog& log, const std::optional<double>& from_s) {
  const std::size_t first = has_row_of_rest(log) ? 1 : 0;
  if (from_s && *from_s < log.t_s[first]) {
    return input_error(ErrorCode::kTooFewData, log.file,
                       fmt::format("the log begins at {:g} s, but {} is {:g} s; give a later time",
                                   log.t_s[first], option_text("from"), *from_s));
  }
  for (std::size_t row = first; row < log.rows(); ++row) {
    const bool commands = log.force_left[row] != 0.0 || log.force_right[row] != 0.0 ||
                          (log.steering_command_rad && (*log.steering_command_rad)[row] != 0.0);
    if (from_s ? log.t_s[row] >= *from_s : commands) return row;
  }
  return input_error(
      ErrorCode::kTooFewData, log.file,
      from_s ? fmt::format("the log ends before {:g} s ({}); give an earlier time", *from_s,
                           option_text("from"))
             : "the log commands nothing (every force and steering command is 0); give the log of "
               "a drive with commands");
}

LoopConditions conditions_in(const DrivingLog& log, std::size_t first, const Vehicle& vehicle) {
  LoopConditions c = conditions_of(vehicle);
  const SensorQuality& given = vehicle.sensors;
  const auto take = [&](LogChannel which, bool is_given, double to_unit, double& noise) {
    if (!is_given && log[which]) noise = noise_in(log, which, first) * to_unit;
  };
  take(LogChannel::kHeading, given.heading_deg.has_value(), degrees(1.0), c.heading_noise_deg);
  take(LogChannel::kYawRate, given.yaw_rate_degps.has_value(), degrees(1.0),
       c.yaw_rate_noise_degps);
  take(LogChannel::kSpeed, given.speed_mps.has_value(), 1.0, c.speed_noise_mps);
  return c;
}

std::vector<DriveChannel> channels_of(const DrivingLog& log, std::size_t first, double duration_s,
                                      const Scenario& scenario) {
  std::vector<DriveChannel> channels;
  for (const LogChannel which : kChannels) {
    if (log[which]) {
      channels.push_back(measured_channel(log, which, first, duration_s, scenario));
    }
  }
  const auto add_command = [&](const char* name, const char* unit, auto of_run,
                               const std::vector<double>& values) {
    DriveChannel& channel = channels.emplace_back(
        DriveChannel{.name = name, .unit = unit, .of_run = of_run, .t_s = {}, .measured = {}});
    take_rows(
        log, first, duration_s, [](std::size_t) { return true; },
        [&](std::size_t row) { return values[row]; }, channel);
  };
  add_command(
      "force_left", "1", [](const RunRow& row) { return row.force.left; }, log.force_left);
  add_command(
      "force_right", "1", [](const RunRow& row) { return row.force.right; }, log.force_right);
  if (log.steering_command_rad) {
    add_command(
        "steering_cmd_rad", "rad", [](const RunRow& row) { return row.steering_command_rad; },
        *log.steering_command_rad);
  }
  std::erase_if(channels, [](const DriveChannel& channel) { return channel.t_s.empty(); });
  return channels;
}

DriveStart start_of(const DrivingLog& log, std::size_t first,
                    const std::vector<DriveChannel>& channels, const Scenario& scenario) {
  DriveStart start{.state = scenario.initial};
  for (const LogChannel which : kChannels) {
    if (!log[which]) continue;
    double sum = 0.0;
    int count = 0;
    for (std::size_t row = first + 1; row-- > 0;) {
      if (log.t_s[first] - log.t_s[row] > kWindow_s) break;
      if (!log[which]->fresh[row]) continue;
      sum += log[which]->value[row];
      ++count;
    }
    if (count == 0) continue;
    channel_of(start.state, which) = sum / count;
    for (const DriveChannel& channel : channels) {
      if (channel.name == info(which).name) {
        channel_of(start.error, which) = channel.noise / std::sqrt(count);
      }
    }
  }
  return start;
}

WindowMeans means_of(const DriveChannel& channel, double duration_s) {
  return means(channel, duration_s, [&](std::size_t i) { return channel.measured[i]; });
}

WindowMeans means_of(const DriveChannel& channel, const Run& run, double sample_time_s,
                     double duration_s, Random* random) {
  WindowMeans windows = means(channel, duration_s, [&](std::size_t i) {
    return at_time(channel, run, sample_time_s, channel.t_s[i]);
  });
  if (random == nullptr || channel.noise_in_run) return windows;
  for (std::size_t w = 0; w < windows.mean.size(); ++w) {
    // The mean of n readings with independent noise sigma has the noise sigma/sqrt(n).
    const double noise = channel.noise * random->normal();
    if (windows.rows[w] > 0) windows.mean[w] += noise / std::sqrt(windows.rows[w]);
  }
  return windows;
}

}  // namespace awmr
