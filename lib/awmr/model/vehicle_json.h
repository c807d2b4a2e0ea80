/// Converts the vehicle and the range of a motor's force to and from JSON. Used for vehicle.json,
/// for `/vehicle` of model.json, and for the unmodelled variation (key `open`) in a search for
/// gains. Not installed; include from .cpp files only.
#pragma once

#include "awmr/core/interval.h"
#include "awmr/core/json/json.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Reads every key of the vehicle. Unknown or missing keys and values out of range (ranges.h) are
/// added to the faults of `json`.
Vehicle vehicle_from_json(JsonObject& json);

/// Completes the messages of faults of vehicle_from_json(): adds the unit in which a number was
/// probably given, and the drive to use in place of `rear_wheel`. `vehicle`: the JSON object;
/// `place`: its place in the faults, "FILE:" or "FILE:/vehicle".
void explain_vehicle_faults(const Json& vehicle, const std::string& place,
                            std::vector<Fault>& faults);

/// Writes the vehicle, including default values. An optional quantity that is not known gets no
/// key.
Json vehicle_to_json(const Vehicle& vehicle);

/// Reads `{min, max}` of F' of one wheel divided by F_max: -1 <= min <= 0 < max <= 1.
Interval wheel_force_from_json(JsonObject json);
Json wheel_force_to_json(const Interval& force);

}  // namespace awmr
