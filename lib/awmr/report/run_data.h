/// The simulated runs and the compared samples, as the page needs them. Private to this folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "awmr/core/json.h"

namespace awmr {

/// The files `run_SCENARIO_MODE_GAINS.csv`, by name: [{scenario, mode, gains, columns: {t_s: [...]}}],
/// angles in degrees, with as many rows as a chart needs (drawn_rows.h).
/// Files that `is_own` is false for are passed over. Errors: as read_csv and `is_own`; a run's time goes
/// back.
Result<Json> read_runs(const std::filesystem::path& directory,
                       const std::function<Result<bool>(const std::string& name)>& is_own);

/// The files `scenario_SCENARIO.json` as they are, by SCENARIO. Errors: as read_scenario.
Result<Json> read_scenarios(const std::filesystem::path& directory);

/// comparison.csv as {scenario: {mode: {metric: [values, ascending]}}}: the samples without the
/// nominal run, of many those at even ranks. Errors: as read_file; a row has too few or too many
/// cells.
Result<Json> read_samples(const std::filesystem::path& path);

}  // namespace awmr
