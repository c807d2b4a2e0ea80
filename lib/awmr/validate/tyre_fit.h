/// Fits the tyres of the four-wheel plant (model/tyres.h) to driving logs, and compares which plant
/// predicts the logs better: four wheels or the 3-DOF model.
///
/// The tyre parameters are the friction mu and the cornering stiffness c_a; all other parameters stay
/// as identified. The logs are divided into windows of 5 s, at most 60, evenly chosen. Each window is
/// replayed from its measured state. Errors of its first second do not count, and from errors of heading
/// and position their mean over the window is subtracted. With e the errors of a channel c and n_c their
/// number,
///
///     minimise over log mu, log c_a:    sum over c of n_c log(sum e^2 / n_c)
///
/// by weighted least squares. The weights 1/(sum e^2 / n_c) are updated after each fit. Errors within a
/// window are correlated, those of different windows are not, so the standard errors are those of the
/// jackknife over the W windows. With the weighted Jacobian J_w and errors e_w of a window, and
/// H = sum J_w' J_w, the covariance of x = (log mu, log c_a) is
///
///     C = (W - 1)/W sum d_w d_w',    d_w = (H - J_w' J_w)^-1 J_w' e_w
///
/// A log with fewer rows than the controller has samples lacks commands, which changes the friction by
/// several per cent if commands change fast. Then the fit is repeated with every other command of the log,
/// held over two rows. With x2 its result, the standard errors become sqrt(C + ((x2 - x)/2)^2).
///
/// The better plant is found by cross-validation: the tyres are fitted to every other window and
/// predict the rest, then the two halves are exchanged. For each held-out window
///
///     D_w = sum over c of log(sum e^2 of the 3-DOF model / sum e^2 of the four wheels).
///
/// The mean of D_w has a 95 % interval by Student's t over the windows; if it contains 0, neither plant is
/// better. The 3-DOF model may have been fitted to the same windows, which is to its advantage.
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

/// Prediction errors of both plants for one channel of windows that the tyres were not fitted to.
struct HeldOutError {
  std::string channel;          ///< "yaw_rate_radps"
  double model_rms = 0.0;       ///< RMS error of the 3-DOF plant in SI units, >= 0
  double four_wheel_rms = 0.0;  ///< RMS error of the four-wheel plant in SI units, >= 0
};

/// Result of fit_tyres().
struct TyreFit {
  Tyres<double> tyres;               ///< a parameter that the logs do not determine has its default
  std::optional<Estimate> friction;  ///< mu; absent if the logs do not determine it
  /// c_a, 1/rad; absent if the logs do not determine it.
  std::optional<Estimate> cornering_per_rad;
  int windows = 0;                          ///< number of windows of 5 s, >= kFewestTyreWindows
  std::vector<HeldOutError> held_out = {};  ///< by channel
  /// The plant with the smaller errors on held-out windows; absent if the interval of D_w contains 0.
  std::optional<PlantKind> better = {};
};

inline constexpr std::size_t kFewestTyreWindows = 12;
/// Written in place of the name of the better plant if neither is better.
inline constexpr std::string_view kUndecidedPlant = "undecided";

/// Fits the tyres to the logs. A parameter is determined if it is inside its range and the standard
/// error of its logarithm is at most 0.5. A single parameter that is not determined keeps its default
/// (warning `tyres-not-shown`).
/// Returns nothing if the fit fails; a finding has the reason: `tyres-need-turns` (too few windows, or a
/// kind of turn is missing), `tyres-not-shown` (neither parameter is determined), `tyres-not-converged`.
/// Other findings: `plants-compared` (note), `inertia-of-logs` (I'z was fitted to logs on the 3-DOF plant
/// and can include moments of the tyres). Errors (input): the model lacks a parameter, or the vehicle
/// does not drive all four wheels.
Result<std::optional<TyreFit>> fit_tyres(const std::vector<DrivingLog>& logs, const Model& model,
                                         std::vector<Finding>& findings);

/// Reads `/tyres` of a validation.json. Errors (input): the file has no tyres, or a number is out of
/// range.
Result<TyreFit> read_tyres(const std::filesystem::path& path);

}  // namespace awmr
