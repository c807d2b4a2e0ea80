/// Output-error fit of the whole model to driving logs. Private to identify/.
///
/// The model is driven by the logged commands and compared with everything that was measured. Long
/// logs are cut into windows, each with its own initial state (multiple shooting; the windows are
/// not tied to each other, so a disturbance spoils one window and not the rest). The noise of each
/// channel is estimated from its residuals; where these are correlated, the channel's errors are
/// taken as a first- order process (correlation e^(-dt/tau)) and whitened.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "awmr/identify/options.h"
#include "awmr/trials/replay.h"

namespace awmr {

/// One free number of the fit: a parameter of the model, the delay or a channel's bias.
struct FreeQuantity {
  enum class Kind { kParameter, kDelay, kBias };
  Kind kind = Kind::kParameter;
  ParameterId id = ParameterId::kMassNorm;  ///< of kParameter
  LogChannel channel = LogChannel::kX;      ///< of kBias
  bool logarithmic = false;                 ///< the coordinate is ln of the value
  double scale = 1.0;  ///< a change of the coordinate of this size would be large

  std::string name() const;
  double value(double coordinate) const;
  double jacobian(double coordinate) const;  ///< d value / d coordinate
};

struct LogFitOptions {
  Vehicle vehicle;
  /// Start values by parameter, also for those that are held.
  std::map<ParameterId, double> start;
  /// Parameters whose start is a guess: these are drawn for the random starts.
  std::vector<ParameterId> guessed;
  std::vector<ParameterId> free;
  bool delay = false;
  std::vector<LogChannel> biases;
  Loss loss = Loss::kSquared;
  std::uint64_t seed = 1;
  int starts = 6;
  int bootstrap = 0;
  int threads = 0;
};

/// A channel's errors as estimated.
struct ChannelNoise {
  double std = 1.0;            ///< SI
  double correlation_s = 0.0;  ///< tau; 0: white
  double step_s = 0.0;         ///< mean time between samples
  double sensor_std = 0.0;     ///< what the signal's own roughness shows, without a model

  /// Errors far above the sensor's and correlated over a second or more are the model's.
  bool of_the_model() const { return std > 3.0 * sensor_std && correlation_s >= 1.0; }
  int count = 0;
};

struct LogFit {
  std::vector<FreeQuantity> quantities;
  Eigen::VectorXd coordinates;
  Eigen::MatrixXd covariance;      ///< over the coordinates; directions that nothing shows left out
  std::vector<bool> identifiable;  ///< by quantity
  std::vector<std::string> why;    ///< by quantity, where it is not
  std::vector<std::optional<Interval>> bootstrap95;  ///< of the value, by quantity, where asked for
  std::map<LogChannel, ChannelNoise> noise;
  /// -2 ln L + 2 p with the noise at its estimate: n ln(sigma^2 (1 - phi^2)) over the channels.
  double aic = 0.0;
  EstimatorReport report;
  bool usable = false;
};

/// Precondition: at least one log, at least one free quantity, a start for every parameter.
LogFit fit_logs(const std::vector<DrivingLog>& logs, const LogFitOptions& options);

/// The plant at a set of values; all parameters are there.
Plant<double> plant_at(const Vehicle& vehicle, const std::map<ParameterId, double>& values);

/// Root mean square error of each measured channel when the model runs over the log in windows,
/// over the channel's standard deviation (NRMSE).
std::map<LogChannel, double> prediction_error(const DrivingLog& log, const Plant<double>& plant,
                                              double delay_s);

}  // namespace awmr
