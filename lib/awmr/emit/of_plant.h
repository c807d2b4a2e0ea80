/// Standard errors of numbers that are computed from a model's plant. Private to emit/.
#pragma once

#include <functional>
#include <optional>

#include "awmr/model/model.h"

namespace awmr {

/// Computes a number from the plant. NaN if the plant has no such number, as for a speed that it
/// never reaches.
using OfPlant = std::function<double(const Plant<double>&)>;

/// Returns the standard error of f, to first order in the fitted parameters p. C is their
/// covariance, g = df/dp:
///   Var f = g^T C g
/// Given parameters count as exact. Absent if f does not depend on any fitted parameter, if it
/// depends on a parameter that is neither given nor in C, or if the result is not finite.
std::optional<double> std_error_of(const Model& model, const OfPlant& f);

}  // namespace awmr
