/// tune.json: what the search is to do.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/tune.h"

namespace awmr {

struct TuneConfig {
  TuneOptions options;
  /// The files that `options.scenarios` came from, for an output's list of inputs.
  std::vector<std::filesystem::path> scenario_files;
};

/// tune.json (`awmr.tune/1`), strict, every key optional:
///   schema, form ("paper" | "strict"), margin, weights {itae, overshoot, control_variation,
///   effort, speed_itae}, bounds {lambda, mu, epsilon, speed_mu, speed_epsilon: [lo, hi]},
///   nominal, draws (4), judged_draws (50; with goals 500), tail_share, activity_max,
///   open {mass_factors [...], wheel_forces [{min, max}, ...]}: the two numbers above are then, where nobody
///   gives them, the next multiple of how many combinations there are,
///   sensitivity (0: none),
///   goals [{at_most {FIGURE: limit, ...}, share (0.95), mode, soft (false)}, ...],
///   global_evaluations, local_evaluations, seed, scenarios [path relative to the file, ...].
/// Errors (input): as read_json_file and read_scenario; unknown keys, values out of range.
Result<TuneConfig> read_tune_config(const std::filesystem::path& path);

/// The JSON Schema of tune.json, from what reads it.
std::string tune_schema();

}  // namespace awmr
