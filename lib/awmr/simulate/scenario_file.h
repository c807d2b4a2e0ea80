/// Reads scenario.json (`awmr.scenario/1`).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "awmr/core/result.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Reads a scenario. Errors: those of read_json_file(); unknown or missing keys; values out of
/// range (scenario_json.h); keys that have no effect or contradict each other.
Result<Scenario> read_scenario(const std::filesystem::path& path);
/// Reads a scenario from the text of a file. `file`: its name in errors. Errors: those of
/// read_json_text(); otherwise those of read_scenario().
Result<Scenario> scenario_from_text(std::string_view text, const std::string& file);

/// Returns the JSON Schema of scenario.json, derived from its reader.
std::string scenario_schema();

}  // namespace awmr
