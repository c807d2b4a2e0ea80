/// tune.json: the options of the search.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/tune.h"

namespace awmr {

struct TuneConfig {
  TuneOptions options;
  /// The files that `options.scenarios` came from, for an output's list of inputs.
  std::vector<std::filesystem::path> scenario_files;
  std::optional<std::filesystem::path> baseline_file = {};  ///< the same of `options.baseline`
};

/// The baseline that "pole-placement" (none is given), "paper" or the path of a gains.json names. Errors:
/// as read_gains.
Result<std::optional<Baseline>> baseline_named(const std::filesystem::path& name);

/// tune.json (`awmr.tune/1`), strict, every key optional:
///   schema, mode (the only one tuned for), form ("paper" | "strict"), margin, weights {settling, itae, overshoot,
///   control_variation, effort, speed_itae}, bounds {lambda, mu, epsilon, speed_mu, speed_epsilon: [lo, hi]},
///   nominal, draws (32), judged_draws (50; with goals 500), tail_share, activity_max,
///   limits {steering_rate_rms_degps, damping, late_damping, delayed_damping, noise_share},
///   baseline ("pole-placement" | "paper" | path of a gains.json relative to the file),
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
