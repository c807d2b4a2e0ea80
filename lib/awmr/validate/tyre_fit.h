/// The tyres of the four-wheel plant (model/tyres.h), fitted to driving logs, and which plant predicts
/// them better.
///
/// All else of the vehicle stays as identified. The logs are cut into windows of 5 s, each replayed from
/// its measured state; the first second does not count, and errors of headings and positions are about
/// their mean in the window. Of more than 60 windows 60 are used, evenly
/// chosen. With e the errors of a channel c and n_c their number,
///
///     minimise over log mu, log c_a:    sum over c of n_c log(sum e^2 / n_c)
///
/// by least squares whose weights 1/(sum e^2 / n_c) follow the fit. Errors of one window go together,
/// those of two windows do not: standard errors are those of the jackknife over the W windows. With J_w and
/// e_w of a window, weighted, and H = sum J_w' J_w,
///
///     C = (W - 1)/W sum d_w d_w',    d_w = (H - J_w' J_w)^-1 J_w' e_w
///
/// A log with fewer rows than the controller has samples lacks commands, and a friction from it may be several per
/// cent off where the commands change fast. With x2 the fit to the logs with every other command, held over two rows,
/// the standard errors become sqrt(C + ((x2 - x)/2)^2).
///
/// Which plant predicts better is judged by cross-validation: the tyres are fitted to every other window
/// and predict the rest, and the other way round. Of each held-out window
///
///     D_w = sum over c of log(sum e^2 of the 3-DOF model / sum e^2 of the four wheels),
///
/// whose mean has a 95 % interval by Student's t over the windows. The 3-DOF model may have been fitted to
/// the same windows, which is to its advantage.
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
  double model_rms = 0.0;       ///< of the 3-DOF plant, SI, >= 0
  double four_wheel_rms = 0.0;  ///< SI, >= 0
};

struct TyreFit {
  Tyres<double> tyres;               ///< a parameter that the logs do not show is at its default
  std::optional<Estimate> friction;  ///< mu; absent: the logs do not show it
  std::optional<Estimate> cornering_per_rad;  ///< c_a, 1/rad; likewise
  int windows = 0;                            ///< of 5 s each, >= kFewestTyreWindows
  std::vector<HeldOutError> held_out = {};    ///< by channel
  /// The plant with the smaller errors on held-out windows; absent: they do not decide.
  std::optional<PlantKind> better = {};
};

inline constexpr std::size_t kFewestTyreWindows = 12;
/// In place of the better plant's name where there is none.
inline constexpr std::string_view kUndecidedPlant = "undecided";

/// None: the logs do not show the tyres, and a finding says why: `tyres-need-turns` (a kind of turn or
/// windows are missing), `tyres-not-shown` (no parameter inside its range with a factor of e^0.5 as
/// standard error), `tyres-not-converged`. A single parameter that is not shown is held at its default
/// (`tyres-not-shown`, a warning). Findings `plants-compared` (note), `inertia-of-logs` (I'z was fitted to
/// logs on the 3-DOF plant and may hold moments of the tyres). Errors (input): the model lacks a
/// parameter, or the plant does not drive all four wheels.
Result<std::optional<TyreFit>> fit_tyres(const std::vector<DrivingLog>& logs, const Model& model,
                                         std::vector<Finding>& findings);

/// /tyres of a validation.json. Errors (input): it has none, or a number is out of range.
Result<TyreFit> read_tyres(const std::filesystem::path& path);

}  // namespace awmr
