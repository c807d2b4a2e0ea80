/// Windows of driving logs, replayed on the 3-DOF plant and on four wheels with tyres, and the errors of
/// both. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/trials/replay.h"

namespace awmr::tyre_fit {

inline constexpr double kWindow_s = 5.0;

/// log mu and log c_a.
using LogTyres = Eigen::Vector2d;
inline constexpr Eigen::Index kFriction = 0;
inline constexpr Eigen::Index kCornering = 1;

Tyres<double> tyres_at(const LogTyres& at);

/// A log, prepared for replay.
struct ReplayedLog {
  LogSignals signals;
  std::optional<LaggedForces> lagged;
  /// The servo's angle at each row, rad, from its commands; empty where the angle itself was logged.
  std::vector<double> angles_rad;

  ReplayedLog(const DrivingLog& log, const Plant<double>& plant, double motor_lag_s);
  const LaggedForces* motors() const { return lagged ? &*lagged : nullptr; }
  /// The measured state as the rows begin, with the servo as its commands have left it.
  State<double> state_before(const LogWindow& rows) const;
};

/// In the order of the logs, which have to outlive them.
std::vector<ReplayedLog> replayed_logs(const std::vector<DrivingLog>& logs,
                                       const Plant<double>& plant, double motor_lag_s);

struct ReplayedWindow {
  const ReplayedLog* log = nullptr;
  LogWindow rows;
  State<double> initial{};
  std::vector<LogChannel> channels = {};  ///< of the errors, in their order
};

using Windows = std::vector<const ReplayedWindow*>;

/// The windows of the logs that have errors.
std::vector<ReplayedWindow> windows_in(const std::vector<DrivingLog>& logs,
                                       const std::vector<ReplayedLog>& replayed);

/// All windows, or 60 over the whole of the logs: more make the fit long and little better.
Windows evenly_chosen(const std::vector<ReplayedWindow>& all);

/// Whether a window has a differential turn, or a steered one.
struct Turns {
  bool by_sides = false;
  bool by_steering = false;
};

Turns turns_in(const LogWindow& rows, const Plant<double>& plant);

/// The vehicle on both plants, each with the steps that it needs.
struct Plants {
  explicit Plants(const Plant<double>& plant)
      : model_step_s(replay_step_s(plant)),
        model(resolved_beside_friction(plant, model_step_s)),
        four_wheel_step_s(replay_step_s(on_tyres(plant))),
        body(resolved_at_rest_on_tyres(on_tyres(plant), four_wheel_step_s)) {}

  /// Without the resistances that tyres replace, and their short steps.
  static Plant<double> on_tyres(Plant<double> plant) {
    plant.sway_alpha = 0.0;
    plant.yaw = {.alpha = 1e-9, .beta = 1.0};
    return plant;
  }
  double model_step_s;
  Plant<double> model;
  double four_wheel_step_s;
  Plant<double> body;
};

/// The errors of the 3-DOF model; infinite where it diverges.
Eigen::VectorXd errors_of_model(const ReplayedWindow& window, const Plants& plants);
/// The errors on tyres. None: no step is short enough for them.
std::optional<Eigen::VectorXd> errors_on_tyres(const ReplayedWindow& window, const Plants& plants,
                                               const LogTyres& tyres);

/// 1/(root mean square error) by channel; 0 for a channel without errors.
using Weights = std::array<double, kChannelCount>;

/// Number and sum of squares of the errors by channel.
struct ErrorSums {
  std::array<double, kChannelCount> squares{};
  std::array<double, kChannelCount> count{};

  void add(const ReplayedWindow& window, const Eigen::VectorXd& errors) {
    for (Eigen::Index i = 0; i < errors.size(); ++i) {
      const std::size_t channel = at(window.channels[at(i)]);
      squares[channel] += errors[i] * errors[i];
      count[channel] += 1.0;
    }
  }
  double mean_square(std::size_t channel) const {
    return count[channel] > 0.0 ? squares[channel] / count[channel] : 0.0;
  }
  Weights weights() const {
    Weights of{};
    for (std::size_t c = 0; c < kChannelCount; ++c) {
      if (squares[c] > 0.0) of[c] = 1.0 / std::sqrt(mean_square(c));
    }
    return of;
  }
  double cost() const {
    double sum = 0.0;
    for (std::size_t c = 0; c < kChannelCount; ++c) {
      if (squares[c] > 0.0) sum += count[c] * std::log(mean_square(c));
    }
    return sum;
  }
};

std::optional<ErrorSums> sums_on_tyres(const Windows& windows, const Plants& plants,
                                       const LogTyres& tyres);

}  // namespace awmr::tyre_fit
