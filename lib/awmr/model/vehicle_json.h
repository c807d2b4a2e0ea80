/// The vehicle as JSON, as vehicle.json and within model.json. Private to this folder; include from
/// .cpp files only.
#pragma once

#include "awmr/core/json.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Reads every key of the vehicle and rejects others; faults are added to those of `json`.
Vehicle vehicle_from_json(JsonObject& json);

/// The vehicle with explicit defaults; an unknown optional quantity has no key.
Json vehicle_to_json(const Vehicle& vehicle);

}  // namespace awmr
