/// Precision of a model's parameters: decides whether enough trials were recorded.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "awmr/model/model.h"

namespace awmr {

/// Precision of one parameter.
struct Precision {
  ParameterId id{};
  /// Half of the width of the 95 % interval, divided by the value unless the parameter is an
  /// exponent; dimensionless, >= 0. Absent if the parameter was given or has no interval.
  std::optional<double> half_width;
};

/// Precision of the parameters in `requested`. If that is empty: of every parameter of the vehicle
/// that was not given, without terms that only some families have, because a term that is 0 has no
/// relative width.
std::vector<Precision> precision_of(const Model& model, std::span<const ParameterId> requested);

/// True if every half width is present and at most `limit`. False for an empty list.
bool is_enough(std::span<const Precision> precisions, double limit);

}  // namespace awmr
