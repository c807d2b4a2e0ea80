/// Reads vehicle.json (`awmr.vehicle/1`).
#pragma once

#include <filesystem>
#include <string>

#include "awmr/core/result.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Reads vehicle.json. Errors: those of read_json_file(); unknown or missing keys; values out of
/// range (ranges.h).
Result<Vehicle> read_vehicle(const std::filesystem::path& path);

/// The JSON Schema of vehicle.json, derived from its reader.
std::string vehicle_schema();

}  // namespace awmr
