/// The search for the tyres with the smallest errors (tyre_fit.h). Private to this folder.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "awmr/validate/tyre_windows.h"

namespace awmr::tyre_fit {

using IsFree = std::array<bool, 2>;  ///< by kFriction, kCornering

struct Fit {
  LogTyres at;
  Weights weights{};
  double cost = 0.0;  ///< sum of n_c log(sum e^2 / n_c)
  bool converged = false;
  std::string stop_reason = {};
};

/// The tyres with the least cost, searched from `from`; what is not free stays there. None: the windows
/// cannot be replayed there.
std::optional<Fit> fit(const Windows& windows, const Plants& plants, const IsFree& is_free,
                       const LogTyres& from);

/// Fits the parameters that the windows identify; the others are held at their defaults.
struct ShownFit {
  Fit fit;
  IsFree is_free{true, true};
  std::array<std::optional<double>, 2> errors;
};

LogTyres default_tyres();

/// None: the windows cannot be replayed from any start.
std::optional<ShownFit> fit_what_is_shown(const Windows& windows, const Plants& plants);

}  // namespace awmr::tyre_fit
