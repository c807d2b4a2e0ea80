/// Converts the range of a motor's force to and from JSON, for vehicle.json and for the unmodelled
/// variation (`open`) of a search for gains. Include from .cpp files only.
#pragma once

#include "awmr/core/interval.h"
#include "awmr/core/json.h"

namespace awmr {

/// Reads `{min, max}` of F' of one wheel over F_max: -1 <= min <= 0 < max <= 1.
Interval wheel_force_from_json(JsonObject json);
Json wheel_force_to_json(const Interval& force);

}  // namespace awmr
