/// The vehicle as JSON, alone (vehicle.json) and within model.json. Private to this folder: from
/// .cpp files only.
#pragma once

#include "awmr/core/json.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Reads every key of the vehicle and refuses others; faults go where `json` collects them.
Vehicle vehicle_from_json(JsonObject& json);

/// The vehicle with its defaults written out; an optional quantity that is not known has no key.
Json vehicle_to_json(const Vehicle& vehicle);

}  // namespace awmr
