/// Converts the vehicle to and from JSON, for vehicle.json and for `/vehicle` of model.json.
/// Private to this folder; include from .cpp files only.
#pragma once

#include "awmr/core/json.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Reads every key of the vehicle. Unknown or missing keys and values out of range (ranges.h) are
/// added to the faults of `json`.
Vehicle vehicle_from_json(JsonObject& json);

/// Writes the vehicle. Default values are written, too. An optional quantity that is not known gets
/// no key.
Json vehicle_to_json(const Vehicle& vehicle);

}  // namespace awmr
