/// scenario.json (`awmr.scenario/1`).
#pragma once

#include <filesystem>

#include "awmr/core/result.h"
#include "awmr/simulate/scenario.h"

namespace awmr {

/// Errors: as read_json_file; unknown, missing or impossible values.
Result<Scenario> read_scenario(const std::filesystem::path& path);

}  // namespace awmr
