/// Least-squares search for the tyre parameters that minimise the cost of tyre_fit.h. Private to
/// validate/.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "awmr/validate/tyre_windows.h"

namespace awmr::tyre_fit {

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
