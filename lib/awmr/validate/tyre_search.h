/// Least-squares search for the tyre parameters with the smallest cost (tyre_fit.h). Private to
/// validate/.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "awmr/validate/tyre_windows.h"

namespace awmr::tyre_fit {

/// Whether a parameter is fitted (else held), by kFriction and kCornering.
using IsFree = std::array<bool, 2>;

/// Result of a search.
struct Fit {
  LogTyres at;
  Weights weights{};
  double cost = 0.0;  ///< sum of n_c log(sum e^2 / n_c)
  bool converged = false;
  std::string stop_reason = {};
};

/// Searches the tyres with the smallest cost from the start `from`. Parameters that are not free stay at
/// their start. Empty if the windows cannot be replayed with the start.
std::optional<Fit> fit(const Windows& windows, const Plants& plants, const IsFree& is_free,
                       const LogTyres& from);

/// Fit of the parameters that the windows determine; the others are held at their defaults.
struct ShownFit {
  Fit fit;
  IsFree is_free{true, true};                   ///< true: the windows determine the parameter
  std::array<std::optional<double>, 2> errors;  ///< standard errors of the logarithms
};

LogTyres default_tyres();

/// Fits both parameters from several starts, then holds those that the windows do not determine. Empty
/// if the windows cannot be replayed from any start.
std::optional<ShownFit> fit_what_is_shown(const Windows& windows, const Plants& plants);

}  // namespace awmr::tyre_fit
