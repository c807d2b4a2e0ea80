/// The errors of a channel as a fit of logs takes them. Private to identify/.
#pragma once

#include <map>
#include <vector>

#include "awmr/identify/logs/windows.h"

namespace awmr {

/// A first-order process: standard deviation sigma, correlation e^(-dt/tau) between two errors.
struct ChannelNoise {
  double std = 1.0;            ///< sigma, SI
  double correlation_s = 0.0;  ///< tau; 0: white
  double step_s = 0.0;         ///< mean time between samples
  double sensor_std = 0.0;     ///< what the signal's own roughness shows, without a model
  int count = 0;               ///< samples

  /// Errors far above the sensor's that stay for a second or more are the model's.
  bool of_the_model() const { return std > 3.0 * sensor_std && correlation_s >= 1.0; }
};

using NoiseLevels = std::map<LogChannel, ChannelNoise>;

/// Data without noise still have to weigh something.
inline constexpr double kMinimumStd = 1e-9;

/// White noise as the roughness of each channel shows it. What is smooth vanishes in the second
/// differences d_k = y_k - 2 y_{k-1} + y_{k-2}, whose variance is 6 sigma^2 for white noise:
///
///     sigma^2 = sum d^2 / (6 n)   over the n second differences within windows
NoiseLevels sensor_noise(const std::vector<FitWindow>& windows);

}  // namespace awmr
