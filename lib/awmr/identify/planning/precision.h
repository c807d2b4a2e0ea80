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
  /// Half of the 95 % interval over the value, dimensionless, >= 0; of an exponent half of the
  /// interval itself. None: no value or no interval yet.
  std::optional<double> half_width;
};

/// Precision of the parameters in `asked`; if that is empty, of every parameter that the vehicle
/// has and that is not given. Terms that only some families have are left out: they may be 0 and
/// have no relative width.
std::vector<Precision> precision_of(const Model& model, std::span<const ParameterId> asked);

/// Every half width is there and at most `limit`, > 0. False for an empty list.
bool is_enough(std::span<const Precision> precisions, double limit);

}  // namespace awmr
