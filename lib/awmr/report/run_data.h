/// The simulated runs and the compared samples in the form used by the page. Private to this
/// folder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "awmr/core/json.h"

namespace awmr {

/// Reads the files `run_SCENARIO_MODE_GAINS.csv`, by name: [{scenario, mode, gains, columns: {t_s:
/// [...]}}], angles in degrees, with as many rows as a chart needs (drawn_rows.h). Files for which
/// `is_own` is false are skipped. Errors: as read_csv and `is_own`; the time of a run is not
/// ascending.
Result<Json> read_runs(const std::filesystem::path& directory,
                       const std::function<Result<bool>(const std::string& name)>& is_own);

/// Reads the files `scenario_SCENARIO.json`, by SCENARIO. Errors: as read_scenario.
Result<Json> read_scenarios(const std::filesystem::path& directory);

/// comparison.csv as {scenario: {mode: {metric: [values, ascending]}}}: the samples without the
/// nominal run, at even ranks if there are many. Errors: as read_file; a row has too few or too
/// many cells.
Result<Json> read_samples(const std::filesystem::path& path);

}  // namespace awmr
