/// Precision of a model's parameters, by which commands decide whether more trials are needed.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "awmr/model/model.h"

namespace awmr {

/// Precision of one parameter.
struct Precision {
  ParameterId id{};
  /// Half width of the 95 % interval, >= 0, divided by the value. For an exponent or a term of a
  /// resistance family, whose values may be 0, the half width is not divided, so it is in the unit
  /// of the parameter. Absent if the parameter was given or has no interval.
  std::optional<double> half_width;
};

/// Precision of the parameters in `requested`. If `requested` is empty: of every parameter that the
/// vehicle has, except given ones and terms that only some families have.
std::vector<Precision> precision_of(const Model& model, std::span<const ParameterId> requested);

/// True if every half width is present and at most `limit`. False for an empty list.
bool is_enough(std::span<const Precision> precisions, double limit);

}  // namespace awmr
