/// Windows of driving logs, their replay on the 3-DOF plant and on four wheels with tyres, and the
/// search for the tyres with the smallest cost (tyre_fit.h). Private to validate/.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/trials/replay.h"

namespace awmr::tyre_fit {

inline constexpr double kWindow_s = 5.0;

/// Logarithms of the friction mu and of the cornering stiffness c_a (1/rad).
using LogTyres = Eigen::Vector2d;
inline constexpr Eigen::Index kFriction = 0;
inline constexpr Eigen::Index kCornering = 1;

Tyres<double> tyres_at(const LogTyres& at);

/// A log, prepared for replay.
struct ReplayedLog {
  LogSignals signals;
  std::optional<LaggedForces> lagged;
  /// Steering angle at each row, rad, simulated from the commands to the servo. Empty if the log
  /// has no steering command.
  std::vector<double> angles_rad;

  ReplayedLog(const DrivingLog& log, const Plant<double>& plant, double motor_lag_s);
  /// Forces after the lag of the motors; nullptr without a lag.
  const LaggedForces* motors() const { return lagged ? &*lagged : nullptr; }
  /// Measured state at the first of the rows, with the simulated steering angle.
  State<double> state_before(const LogWindow& rows) const;
};

/// Prepares the logs, in their order. The logs must outlive the result.
std::vector<ReplayedLog> replayed_logs(const std::vector<DrivingLog>& logs,
                                       const Plant<double>& plant, double motor_lag_s);

/// A window of a log, with its initial state for the replay.
struct ReplayedWindow {
  const ReplayedLog* log = nullptr;
  LogWindow rows;
  State<double> initial{};
  std::vector<LogChannel> channels = {};  ///< channel of each error, in the order of the errors
};

using Windows = std::vector<const ReplayedWindow*>;

/// Divides the logs into windows of kWindow_s. Leaves out windows without a measurement after their
/// first second.
std::vector<ReplayedWindow> windows_in(const std::vector<DrivingLog>& logs,
                                       const std::vector<ReplayedLog>& replayed);

/// Returns at most 60 windows, evenly chosen. More windows would slow down the fit and hardly
/// improve it.
Windows evenly_chosen(const std::vector<ReplayedWindow>& all);

/// Cause of the turns in a window: different left and right wheel forces (by_sides), or the
/// steering. A cause is true if its commands are not near 0, and if its squared yaw moment, summed
/// over the window, is at least 3 times that of the other cause. So at most one cause is true.
struct Turns {
  bool by_sides = false;
  bool by_steering = false;
};

Turns turns_in(const LogWindow& rows, const Plant<double>& plant);

/// The vehicle on both plants, each with the integration step that it needs.
struct Plants {
  explicit Plants(const Plant<double>& plant)
      : model_step_s(replay_step_s(plant)),
        model(resolved_beside_friction(plant, model_step_s)),
        four_wheel_step_s(replay_step_s(on_tyres(plant))),
        body(resolved_at_rest_on_tyres(on_tyres(plant), four_wheel_step_s)) {}

  /// Returns the plant with negligible sway resistance g2 and yaw resistance g3, which the tyre
  /// forces of the four-wheel plant replace. A remaining g3 would require short integration steps.
  static Plant<double> on_tyres(Plant<double> plant) {
    plant.sway_alpha = 0.0;
    plant.yaw = {.alpha = 1e-9, .beta = 1.0};
    return plant;
  }
  double model_step_s;       ///< integration step for `model`, s
  Plant<double> model;       ///< the 3-DOF model
  double four_wheel_step_s;  ///< integration step for the four-wheel plant, s
  Plant<double> body;        ///< vehicle of the four-wheel plant, without its tyres
};

/// Errors (predicted minus measured) of the 3-DOF model in a window; not finite if the simulation
/// diverges.
Eigen::VectorXd errors_of_model(const ReplayedWindow& window, const Plants& plants);
/// Errors of the four-wheel plant with these tyres in a window. Empty if the simulation diverges,
/// or would need a shorter integration step than permitted.
std::optional<Eigen::VectorXd> errors_on_tyres(const ReplayedWindow& window, const Plants& plants,
                                               const LogTyres& tyres);

/// Weights of the errors by channel: 1/(RMS error); 0 for a channel without measurements or with
/// zero errors.
using Weights = std::array<double, kChannelCount>;

/// Number and sum of squares of the errors, by channel.
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

/// Sums over all windows for the four-wheel plant with these tyres. Empty if errors_on_tyres() is
/// empty for a window.
std::optional<ErrorSums> sums_on_tyres(const Windows& windows, const Plants& plants,
                                       const LogTyres& tyres);

/// For kFriction and kCornering: true if the parameter is fitted, false if it has a fixed value.
using IsFree = std::array<bool, 2>;

struct Fit {
  LogTyres at;
  Weights weights{};
  /// The cost that tyre_fit.h minimises.
  double cost = 0.0;
  bool converged = false;
  std::string stop_reason = {};
};

/// Searches the tyres with the smallest cost, starting at `from`. Parameters that are not free keep
/// their value in `from`. Empty if the windows cannot be replayed with `from`.
std::optional<Fit> fit(const Windows& windows, const Plants& plants, const IsFree& is_free,
                       const LogTyres& from);

/// Fit of those tyre parameters (friction, cornering stiffness) that the windows determine; a
/// parameter that they do not determine keeps its default.
struct ShownFit {
  Fit fit;
  IsFree is_free{true, true};  ///< by parameter: true if the windows determine it
  /// Standard errors of the logarithms of the parameters.
  std::array<std::optional<double>, 2> errors;
};

LogTyres default_tyres();

/// Fits friction and cornering stiffness of the tyres from several starts. If the windows do not
/// determine one of the two, sets it to its default and fits the second one again. If a fit does
/// not converge, returns it without further fits (Fit::converged is false). Empty if the windows
/// cannot be simulated from any start.
std::optional<ShownFit> fit_what_is_shown(const Windows& windows, const Plants& plants);

}  // namespace awmr::tyre_fit
