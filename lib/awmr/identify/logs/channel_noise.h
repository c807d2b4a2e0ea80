/// Noise model of a channel in a log fit. Private to identify/.
#pragma once

#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "awmr/identify/logs/windows.h"

namespace awmr {

/// The error of a sample has two parts: white noise of the sensor, independent from sample to
/// sample, and a correlated drift, caused by model errors and by the sensor's filter.
///
///     e_k = d(t_k) + white_k,   E[white_k^2] = sigma_w^2,   E[d^2] = sigma_d^2
///
///     first order    d'  = -d/tau                          + white noise
///     second order   d'' = -2 zeta omega d' - omega^2 d    + white noise
///
/// The second order describes a suspension, a filter or a smoothed sensor: the error is smooth from
/// sample to sample, and oscillates for zeta < 1.
struct ChannelNoise {
  double white_std = 1.0;        ///< sigma_w, SI
  double drift_std = 0.0;        ///< sigma_d, SI; 0: no drift
  double correlation_s = 0.0;    ///< tau, or the duration of the oscillations; 0 without a drift
  double frequency_radps = 0.0;  ///< omega of a drift of second order; 0: first order
  double damping = 0.0;          ///< zeta of a drift of second order, > 0
  double sensor_std = 0.0;  ///< noise from the second differences of the signal, without a model,
                            ///< SI
  int count = 0;            ///< samples
  double cost = 0.0;        ///< -2 ln L of the channel's errors, up to a constant

  double std() const { return std::hypot(white_std, drift_std); }
  bool second_order() const { return frequency_radps > 0.0; }
  /// Number of estimated parameters: sigma_w, and those of the drift.
  int numbers() const { return drift_std > 0.0 ? (second_order() ? 4 : 3) : 1; }
  /// True for a drift above half of the sensor noise that lasts half a second or more: an error of
  /// the model, or a drifting sensor.
  bool of_the_model() const { return drift_std > 0.5 * sensor_std && correlation_s >= 0.5; }
  /// True for a drift that is many times the sensor noise: the model does not describe the vehicle.
  bool overwhelms_sensor() const {
    constexpr double kMany = 2.5;
    return of_the_model() && drift_std > kMany * sensor_std;
  }
  /// True for a drift that a missing term of the model can cause.
  bool has_slow_drift() const { return drift_std > 0.25 * sensor_std && correlation_s > 0.2; }
};

using NoiseLevels = std::map<LogChannel, ChannelNoise>;

/// Smallest noise, so that noise-free data have a finite weight.
inline constexpr double kMinimumStd = 1e-9;

/// Estimates the white noise of each channel from second differences d_k = y_k - 2 y_{k-1} +
/// y_{k-2}. Smooth signals vanish in them, and white noise gives a variance of 6 sigma^2:
///
///     sigma^2 = sum d^2 / (6 n)   over the n second differences within windows
NoiseLevels sensor_noise(const std::vector<FitWindow>& windows);

/// The errors of one channel in one window, in order of time.
struct ErrorSeries {
  std::vector<double> error;    ///< SI
  std::vector<double> since_s;  ///< time since the previous one; 0: the first
};

/// The errors of a fit by channel, with one series per window.
using ErrorsByChannel = std::map<LogChannel, std::vector<ErrorSeries>>;

/// -2 ln L of errors with this noise, up to a constant: sum ln S_k + nu_k^2/S_k.
double cost_of(std::span<const ErrorSeries> series, const ChannelNoise& noise);

/// Maximum-likelihood noise of these errors: white; with a drift of first order if that lowers -2
/// ln L by more than 10; of second order if that lowers it by more than 10 again. `free_share`, in
/// (0, 1]: degrees of freedom of the errors per error. The search begins at `before`, whose
/// sensor_std is kept.
ChannelNoise likeliest_noise(std::span<const ErrorSeries> series, double free_share,
                             const ChannelNoise& before);

}  // namespace awmr
