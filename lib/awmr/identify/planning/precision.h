/// Precision of a model's parameters, and whether enough was recorded.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "awmr/model/model.h"

namespace awmr {

/// Precision of one parameter.
struct Precision {
  ParameterId id{};
  /// Half of the 95 % interval relative to the value, dimensionless, >= 0; for an exponent, half of
  /// the interval. Absent: given, or no value or no interval.
  std::optional<double> half_width;
};

/// Precision of the parameters in `requested`; if that is empty, of every parameter of the vehicle
/// that is not given. Excludes terms that only some families have, because they can be 0 and then
/// have no relative width.
std::vector<Precision> precision_of(const Model& model, std::span<const ParameterId> requested);

/// True if every half width is present and at most `limit`, > 0. False for an empty list.
bool is_enough(std::span<const Precision> precisions, double limit);

}  // namespace awmr
