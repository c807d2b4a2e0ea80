/// Reads scenario.json (`awmr.scenario/1`).
#pragma once

#include <filesystem>
#include <string>

#include "awmr/core/result.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Reads a scenario. Errors: those of read_json_file(); unknown or missing keys; values out of
/// range (scenario_json.h); keys that have no effect or contradict each other.
Result<Scenario> read_scenario(const std::filesystem::path& path);

/// Returns the JSON Schema of scenario.json, derived from its reader.
std::string scenario_schema();

}  // namespace awmr
