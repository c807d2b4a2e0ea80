/// Standard errors of numbers that are computed from a model's plant. Private to emit/.
#pragma once

#include <functional>
#include <optional>

#include "awmr/model/model.h"

namespace awmr {

/// Computes a number from the plant. NaN if the plant has none, as for a speed that it never
/// reaches.
using OfPlant = std::function<double(const Plant<double>&)>;

/// Returns the standard error of the number f, to first order in the errors of the fitted
/// parameters p:
///   Var f = g^T C g,   C: covariance of p,   g = df/dp
/// Given parameters count as exact. Absent if f depends on no fitted parameter, or on a parameter
/// that is neither given nor in C, or if the result is not finite.
std::optional<double> std_error_of(const Model& model, const OfPlant& f);

}  // namespace awmr
