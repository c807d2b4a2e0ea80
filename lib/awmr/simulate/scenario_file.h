/// scenario.json (`awmr.scenario/1`).
#pragma once

#include <filesystem>
#include <string>

#include "awmr/core/result.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Errors: as read_json_file; unknown, missing or impossible values.
Result<Scenario> read_scenario(const std::filesystem::path& path);

/// The JSON Schema of scenario.json, from what reads it.
std::string scenario_schema();

}  // namespace awmr
