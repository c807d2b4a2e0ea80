/// Noise model of a measured channel in a log fit, and its estimation. Private to identify/.
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "awmr/identify/logs/problem/windows.h"

namespace awmr {

/// The error e_k (model minus reading) of sample k at the time t_k is white noise of the sensor
/// plus a drift d. Drift is correlated in time; model errors and sensor filters cause it.
///
///     e_k = d(t_k) + white_k,   E[white_k^2] = sigma_w^2,   E[d^2] = sigma_d^2
///
///     first order    d'  = -d/tau                          + white noise
///     second order   d'' = -2 zeta omega d' - omega^2 d    + white noise
///
/// A suspension, a filter or a smoothed sensor causes a drift of second order. It is smooth from
/// sample to sample, and oscillates if zeta < 1.
///
/// Instead of a drift, a channel can have differenced white noise n. Examples are a speed that a
/// program computes from counts or positions, and a yaw rate computed from headings:
///
///     e_k = n_k - theta n_{k-1},   E[n^2] = sigma_w^2
struct ChannelNoise {
  double white_std = 1.0;        ///< sigma_w, SI
  double drift_std = 0.0;        ///< sigma_d, SI; 0: no drift
  double correlation_s = 0.0;    ///< correlation time tau, or decay time of a second-order drift
  double frequency_radps = 0.0;  ///< omega of a second-order drift; 0: first order
  double damping = 0.0;          ///< zeta of a second-order drift, > 0
  double differenced = 0.0;      ///< theta of differenced noise, 0 to 1; 0: not differenced
  double sensor_std = 0.0;       ///< sensor noise: standard deviation by sensor_noise(), SI
  /// Correlation time, s, that the drift of a sensor filter rarely reaches, see of_the_model(): at
  /// most 0.5 s, less if the motion of the vehicle is faster.
  double longest_filter_s = 0.5;
  int count = 0;      ///< number of samples
  double cost = 0.0;  ///< -2 ln L of the channel's errors, up to a constant

  double std() const { return std::hypot(white_std, differenced * white_std, drift_std); }
  bool second_order() const { return frequency_radps > 0.0; }
  bool is_white() const { return !(drift_std > 0.0) && !(differenced > 0.0); }
  /// Number of estimated noise parameters: 1 (sigma_w), plus 2 of a first-order drift, 3 of a
  /// second-order drift or 1 of differenced noise.
  int numbers() const {
    return drift_std > 0.0 ? (second_order() ? 4 : 3) : differenced > 0.0 ? 2 : 1;
  }
  /// True if the drift is too large and too slow to come from a sensor filter: its correlation time
  /// is above longest_filter_s, or half of it if the drift is large. Its cause is then a model
  /// error, or a drift of the sensor itself.
  bool of_the_model() const {
    return (drift_std > 0.5 * sensor_std && correlation_s >= longest_filter_s) ||
           (drift_std > 1.5 * sensor_std && correlation_s >= 0.5 * longest_filter_s);
  }
  /// True if of_the_model() is true and the drift is above 2.5 times the sensor noise. The model is
  /// then inadequate.
  bool overwhelms_sensor() const {
    constexpr double kMany = 2.5;
    return of_the_model() && drift_std > kMany * sensor_std;
  }
  /// True if the drift is above a quarter of the sensor noise, with a correlation time above 0.2 s.
  /// Such a drift may come from an effect that the model does not contain.
  bool has_slow_drift() const { return drift_std > 0.25 * sensor_std && correlation_s > 0.2; }
};

/// Sensor of a channel, in all logs or in a single log. Logs of one vehicle can have different
/// sensors, for example GPS in one log and motion capture in another.
struct LogSensor {
  LogChannel channel;
  int log = 0;  ///< DrivingLog::number; 0: the noise is the same in all logs

  auto operator<=>(const LogSensor&) const = default;
};

/// Noise of all measured channels. A channel has one sensor for all logs, or one for each log.
using NoiseLevels = std::map<LogSensor, ChannelNoise>;

/// "x_m", or "x_m in log 2" for the sensor of a single log.
std::string describe(const LogSensor& sensor);

std::set<LogChannel> channels_of(const NoiseLevels& levels);

bool has_channel(const NoiseLevels& levels, LogChannel channel);

/// True if `test` is true for the noise of a sensor of this channel.
bool any_sensor(const NoiseLevels& levels, LogChannel channel, bool (ChannelNoise::*test)() const);

/// Sensor of a channel in the log with this number: that of the log, else that of all logs, else
/// that of the first log with one. Precondition: has_channel().
const NoiseLevels::value_type& sensor_in(const NoiseLevels& levels, LogChannel channel, int log);

/// Smallest standard deviation of the noise, SI, so that noise-free data have a finite weight.
inline constexpr double kMinimumStd = 1e-9;

/// Estimates the white noise sigma of each channel from the n second differences of its readings y,
/// d_k = y_k - 2 y_{k-1} + y_{k-2}. The differences of a smooth signal are nearly 0, and those of
/// white noise have the variance 6 sigma^2:
///
///     sigma^2 = sum d^2 / (6 n)
///
/// A channel has one sensor for each log if sigma differs between two logs by more than 30 % and
/// significantly, and each log has at least 30 differences. Otherwise all logs share one sensor.
NoiseLevels sensor_noise(const std::vector<FitWindow>& windows);

/// The same with the sensors of `levels`, for a part of the windows of `levels`.
NoiseLevels sensor_noise(const std::vector<FitWindow>& windows, const NoiseLevels& levels);

/// The errors of one channel in one window, in order of time.
struct ErrorSeries {
  std::vector<double> error;    ///< SI
  std::vector<double> since_s;  ///< time since the previous error, s; 0 for the first
};

/// The errors of a fit by sensor, one series per window.
using ErrorsBySensor = std::map<LogSensor, std::vector<ErrorSeries>>;

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// -2 ln L of errors under a noise model, up to a constant: sum ln S_k + nu_k^2/S_k. The innovation
/// nu_k is the part of error k that the errors before it do not predict, S_k its variance
/// (whitener.h).
/// `most`: limit of each nu_k^2/S_k, so that single errors do not dominate the result.
double cost_of(std::span<const ErrorSeries> series, const ChannelNoise& noise,
               double most = kNoLimit);

/// Returns the most likely noise model of these errors (maximum likelihood). Begins with white
/// noise and makes three steps. The result of a step is kept only if it lowers -2 ln L by more than
/// 10:
///   - Step 1 adds a first-order drift.
///   - Step 2 replaces this drift, if step 1 kept it, by a second-order drift.
///   - Step 3 replaces the result by differenced noise.
///
/// `free_share`: degrees of freedom of the fit over the number of errors, in (0, 1]. The variances
/// are divided by it, because a fit makes the errors smaller than the noise. `before`: noise model
/// of the previous round of settle_noise(). The result has the sensor_std of `before`. If `before`
/// has a second-order drift, the search of step 2 starts at that drift.
ChannelNoise likeliest_noise(std::span<const ErrorSeries> series, double free_share,
                             const ChannelNoise& before);

}  // namespace awmr
