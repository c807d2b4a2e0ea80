/// Fits the tyres of the four-wheel plant (model/tyres.h) to driving logs, and compares which plant
/// predicts the logs better: the four-wheel plant or the 3-DOF model.
///
/// The tyre parameters are the friction mu and the cornering stiffness c_a; all other parameters
/// stay as identified. The logs are divided into windows of 5 s, of which at most 60 are used,
/// evenly chosen. Each window is simulated from its first measured state. Errors in the first
/// second of a window do not count, because the error of the unmeasured part of its initial state
/// must first decay. The mean error of heading and position in the window is subtracted, because
/// the initial pose is a single noisy reading. With the n_c errors e of channel c,
///
///     minimise over log mu, log c_a:    sum over c of n_c log(sum e^2 / n_c)
///
/// by weighted least squares. The weights 1/(sum e^2 / n_c) are updated after each fit. Errors are
/// correlated within a window, but not between windows. Standard errors therefore come from the
/// jackknife over the W windows, which leaves out one window at a time. J_w is the Jacobian of the
/// weighted errors e_w of window w, and H = sum J_w' J_w. The covariance of x = (log mu, log c_a)
/// is
///
///     C = (W - 1)/W sum d_w d_w',    d_w = (H - J_w' J_w)^-1 J_w' e_w
///
/// If the rows of a log are further apart than the controller's sample time, some commands are not
/// in the log. If commands change fast, their absence changes the fitted friction by several per
/// cent. For such logs, a second fit uses only every other command, held over two rows. With the
/// result x2 of that fit, the standard error of each parameter becomes sqrt(C_ii + ((x2 -
/// x)_i/2)^2).
///
/// Cross-validation finds the better plant: the tyres are fitted to every other window and predict
/// the remaining ("held-out") windows; then the two halves are exchanged. For each held-out window
/// w
///
///     D_w = sum over c of log(sum e^2 of the 3-DOF model / sum e^2 of the four wheels).
///
/// If the 95 % interval of the mean of D_w (Student's t over the windows) contains 0, neither plant
/// is better. The comparison favours the 3-DOF model if that model was fitted to the same logs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/simulate/scenario.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Prediction errors of both plants for one channel, on held-out windows.
struct HeldOutError {
  std::string channel;          ///< name: "yaw_rate_radps"
  double model_rms = 0.0;       ///< RMS error of the 3-DOF plant in SI units, >= 0
  double four_wheel_rms = 0.0;  ///< RMS error of the four-wheel plant in SI units, >= 0
};

/// Result of fit_tyres().
struct TyreFit {
  /// Tyres; parameters that the logs do not determine have defaults.
  Tyres<double> tyres;
  std::optional<Estimate> friction;  ///< friction mu; absent if the logs do not determine it
  /// c_a, 1/rad; absent if the logs do not determine it.
  std::optional<Estimate> cornering_per_rad;
  int windows = 0;                          ///< windows of 5 s in the fit, kMinTyreWindows ... 60
  std::vector<HeldOutError> held_out = {};  ///< cross-validated errors by channel
  /// The plant with the smaller errors on held-out windows; absent if the 95 % interval of the mean
  /// of D_w contains 0.
  std::optional<PlantKind> better = {};
};

inline constexpr std::size_t kMinTyreWindows = 12;
/// Text in validation.json instead of the better plant if neither is better.
inline constexpr std::string_view kUndecidedPlant = "undecided";

/// Fits the tyres to the logs. The logs determine a parameter if its estimate is inside its range
/// and the standard error of its logarithm is at most 0.5. A parameter that they do not determine
/// keeps its default (warning `tyres-not-shown`). If the fit fails, returns nothing and adds a
/// finding with the severity error: `tyres-need-turns` (too few windows, or too few with one kind
/// of turn), `tyres-not-shown` (neither parameter is determined), `tyres-not-converged`. Other
/// findings: `plants-compared` (note), `inertia-of-logs` (warning: I'z was fitted to logs with the
/// 3-DOF model and can include moments of the tyres). Errors (input): the model lacks a parameter,
/// or has a time constant too short for a simulation; the vehicle does not drive all four wheels.
/// Precondition: there is at least one log.
Result<std::optional<TyreFit>> fit_tyres(const std::vector<DrivingLog>& logs, const Model& model,
                                         std::vector<Finding>& findings);

/// Reads `/tyres` of a validation.json. Errors (input): the file has no tyres, or a number is out
/// of range.
Result<TyreFit> read_tyres(const std::filesystem::path& path);

}  // namespace awmr
