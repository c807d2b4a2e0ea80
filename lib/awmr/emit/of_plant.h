/// Computes numbers from a model's plant, with propagated uncertainty. Private to emit/.
#pragma once

#include <functional>
#include <optional>

#include "awmr/model/model.h"

namespace awmr {

/// A number computed from the plant; NaN if the plant cannot reach it.
using OfPlant = std::function<double(const Plant<double>&)>;

/// Standard error of f from the model's covariance C, to first order, with g = df/dp:
///   Var f = g^T C g
/// None if f depends on no fitted parameter, or on a parameter without covariance.
std::optional<double> std_error_of(const Model& model, const OfPlant& f);

}  // namespace awmr
