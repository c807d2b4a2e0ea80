/// Reads vehicle.json (`awmr.vehicle/1`).
#pragma once

#include <filesystem>
#include <string>

#include "awmr/core/result.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Name of a drive that is not supported (VEHICLES.md), and the message with the reason.
inline constexpr const char* kRearWheelDrive = "rear_wheel";
inline constexpr const char* kNoRearWheelDrive =
    "rear_wheel is not supported: the model has no lateral tyre forces, so that steered front "
    "wheels turn the vehicle only if they are driven. For driven rear wheels and a castor use "
    "differential";

/// Reads vehicle.json. Errors: those of read_json_file(); unknown or missing keys; values out of
/// range (ranges.h).
Result<Vehicle> read_vehicle(const std::filesystem::path& path);

/// The JSON Schema of vehicle.json, derived from its reader.
std::string vehicle_schema();

}  // namespace awmr
