/// Readers of simulated runs, scenarios and compared samples, as JSON for the page. Private to
/// report/.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "awmr/core/json.h"

namespace awmr {

/// Reads the files `run_SCENARIO_MODE_GAINS.csv`, sorted by name, as [{scenario, mode, gains,
/// columns: {t_s: [...], ...}}]. Angles are in degrees. The rows are reduced to those that a chart
/// needs (drawn_rows.h). Files for which `is_own` returns false are skipped. Errors: as read_csv and
/// `is_own`; the time of a run is not ascending.
Result<Json> read_runs(const std::filesystem::path& directory,
                       const std::function<Result<bool>(const std::string& name)>& is_own);

/// Reads the files `scenario_SCENARIO.json` as {SCENARIO: content}. Errors: as read_scenario.
Result<Json> read_scenarios(const std::filesystem::path& directory);

/// Reads comparison.csv as {scenario: {mode: {metric: [values, ascending]}}}, without the nominal
/// run. Of many samples, evenly spaced ones are kept. Errors: as read_file; a row has too few or too
/// many cells.
Result<Json> read_samples(const std::filesystem::path& path);

}  // namespace awmr
