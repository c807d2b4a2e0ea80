/// The errors of a channel as a fit of logs takes them. Private to identify/.
#pragma once

#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "awmr/identify/logs/windows.h"

namespace awmr {

/// The error of a sample is the sum of two: what the sensor adds, new at every sample, and a drift
/// with a memory, which is what the model misses and what a sensor's filter leaves.
///
///     e_k = drift_k + white_k,   E[drift_k drift_{k-1}] = sigma_d^2 e^(-dt/tau),   E[white_k^2] = sigma_w^2
struct ChannelNoise {
  double white_std = 1.0;      ///< sigma_w, SI
  double drift_std = 0.0;      ///< sigma_d, SI; 0: none was found
  double correlation_s = 0.0;  ///< tau; 0 without a drift
  double sensor_std = 0.0;     ///< what the signal's own roughness shows, without a model, SI
  int count = 0;               ///< samples
  double cost = 0.0;           ///< -2 ln L of the channel's errors, but for a constant

  double std() const { return std::hypot(white_std, drift_std); }
  /// Errors above the sensor's that stay for half a second or more are the model's, or a sensor's that
  /// wanders.
  bool of_the_model() const { return drift_std > sensor_std && correlation_s >= 0.5; }
  /// A drift that a missing term of the model may be behind.
  bool has_slow_drift() const { return drift_std > 0.25 * sensor_std && correlation_s > 0.2; }
};

using NoiseLevels = std::map<LogChannel, ChannelNoise>;

/// Data without noise still have to weigh something.
inline constexpr double kMinimumStd = 1e-9;

/// What is new in each error of a channel, after all that the errors before it told of the drift:
/// a Kalman filter of one state,
///
///     m = phi m,  P = phi^2 P + (1 - phi^2) sigma_d^2,   phi = e^(-dt/tau)
///     nu = e - m,  S = P + sigma_w^2,  m += (P/S) nu,  P -= P^2/S
///
/// so that the nu/sqrt(S) are white where e is as ChannelNoise says. T carries derivatives; the
/// gains depend on the times alone.
template <class T>
class Whitener {
 public:
  /// `noise` must outlive it.
  explicit Whitener(const ChannelNoise& noise)
      : noise_(noise), variance_(noise.drift_std * noise.drift_std) {}

  struct Innovation {
    T value;          ///< nu
    double variance;  ///< S
  };
  /// The next error, `since_s` after the one before it; 0 for the first.
  Innovation next(const T& error, double since_s) {
    const double white = noise_.white_std * noise_.white_std;
    if (!(noise_.drift_std > 0.0)) return {error, white};
    if (since_s > 0.0) {
      if (std::abs(since_s - since_s_) > 1e-6 * since_s) {
        since_s_ = since_s;
        phi_ = std::exp(-since_s / noise_.correlation_s);
      }
      mean_ = phi_ * mean_;
      variance_ =
          phi_ * phi_ * variance_ + (1.0 - phi_ * phi_) * noise_.drift_std * noise_.drift_std;
    }
    const Innovation innovation{error - mean_, variance_ + white};
    const double gain = variance_ / innovation.variance;
    mean_ += gain * innovation.value;
    variance_ -= gain * variance_;
    return innovation;
  }

 private:
  const ChannelNoise& noise_;
  T mean_ = T(0.0);
  double variance_;
  double since_s_ = 0.0;
  double phi_ = 0.0;
};

/// White noise as the roughness of each channel shows it. What is smooth vanishes in the second
/// differences d_k = y_k - 2 y_{k-1} + y_{k-2}, whose variance is 6 sigma^2 for white noise:
///
///     sigma^2 = sum d^2 / (6 n)   over the n second differences within windows
NoiseLevels sensor_noise(const std::vector<FitWindow>& windows);

/// The errors of one channel in one window, in order of time.
struct ErrorSeries {
  std::vector<double> error;    ///< SI
  std::vector<double> since_s;  ///< time since the one before; 0: the first
};

/// The likeliest noise of these errors: white, or with a drift where that is plainly likelier (ten
/// of -2 ln L). `free_share`, in (0, 1]: of the errors' squares, what the fit has not taken for
/// itself. sensor_std is left as it is in `before`.
ChannelNoise likeliest_noise(std::span<const ErrorSeries> series, double free_share,
                             const ChannelNoise& before);

}  // namespace awmr
