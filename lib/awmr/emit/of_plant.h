/// Standard errors of numbers that are computed from a model's plant. Private to emit/.
#pragma once

#include <functional>
#include <optional>

#include "awmr/model/model.h"

namespace awmr {

/// Computes a number from the plant; NaN if there is none, such as a speed that is never reached.
using OfPlant = std::function<double(const Plant<double>&)>;

/// Standard error of f, to first order in the fitted parameters p. C is their covariance, g =
/// df/dp:
///   Var f = g^T C g
/// Given parameters count as exact. Absent if f depends on no fitted parameter, or on a parameter
/// that is neither given nor in C.
std::optional<double> std_error_of(const Model& model, const OfPlant& f);

}  // namespace awmr
