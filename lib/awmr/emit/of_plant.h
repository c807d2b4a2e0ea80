/// Numbers that follow from a model's plant, with the uncertainty that it hands on to them. Private to
/// emit/.
#pragma once

#include <functional>
#include <optional>

#include "awmr/model/model.h"

namespace awmr {

/// A number that follows from the plant; NaN where the plant does not reach it.
using OfPlant = std::function<double(const Plant<double>&)>;

/// The standard error of f by the model's covariance C, to first order, with g = df/dp:
///   Var f = g^T C g
/// None where f hangs on nothing that was fitted, or on something that has no covariance.
std::optional<double> std_error_of(const Model& model, const OfPlant& f);

}  // namespace awmr
