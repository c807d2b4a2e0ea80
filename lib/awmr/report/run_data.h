/// Readers of simulated runs, scenarios and compared samples, as JSON for the page. Private to
/// report/.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "awmr/core/json/json.h"

namespace awmr {

/// Reads the files `run_SCENARIO_MODE_GAINS.csv`, sorted by name, as [{scenario, mode, gains,
/// columns: {t_s: [...], ...}}]. Angles are in degrees. The rows are reduced to those that a chart
/// needs (core/statistics/drawn_rows.h). Files for whose name `is_own` returns false are skipped.
/// Errors: those of read_run() and `is_own`; the directory cannot be read; a file of this name is
/// not a regular file.
Result<Json> read_runs(const std::filesystem::path& directory,
                       const std::function<Result<bool>(const std::string& name)>& is_own);

/// Reads the files `scenario_SCENARIO.json` as {SCENARIO: content}. Errors: those of
/// read_scenario(); the directory cannot be read.
Result<Json> read_scenarios(const std::filesystem::path& directory);

/// Reads comparison.csv as {scenario: {mode: {metric: [values, ascending]}}}, without the nominal
/// run (sample 0). Of more than 60 values, 60 at evenly spaced ranks are kept, with the smallest
/// and the largest. Errors: those of read_file(); a row has too few or too many cells.
Result<Json> read_samples(const std::filesystem::path& path);

}  // namespace awmr
