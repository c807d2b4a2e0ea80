/// Reader of tune.json, the options of tune().
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Content of tune.json, with the files that it names. The output lists these files as inputs.
struct TuneConfig {
  TuneOptions options;
  std::vector<std::filesystem::path> scenario_files;  ///< of `options.scenarios`
  /// File of `options.baseline`, if it was read from one.
  std::optional<std::filesystem::path> baseline_file = {};
  std::set<std::string> keys = {};  ///< the keys that tune.json has
};

/// The baseline with this name: "pole-placement" (no gains, tune() computes them), "paper" or the
/// path of a gains.json. Errors: those of read_mode_gains().
Result<std::optional<Baseline>> baseline_named(const std::filesystem::path& name);

/// Reads tune.json (`awmr.tune/1`). Unknown keys are errors, and every key is optional:
///   schema, form ("paper" | "strict"), margin,
///   mode (the only mode to tune for) or one_set (true: one set of gains for all modes),
///   weights {settling, itae, overshoot, control_variation, effort, speed_itae},
///   bounds {lambda, mu, epsilon, speed_mu, speed_epsilon: [lo, hi]},
///   observer {bandwidth_radps [lo, hi], yaw_max_m, surge_max},
///   no_observer (true: tune() adds no observer),
///   allow_unsettled (true: also gains that never settle in some mode),
///   nominal, or draws (32), judged_draws (draws of the evaluation: 50; with goals 500) and
///   tail_share,
///   activity_max,
///   limits {steering_rate_rms_degps, damping, late_damping, delayed_damping, noise_share},
///   baseline ("pole-placement" | "paper" | path of a gains.json relative to the file),
///   open {mass_factors [...], wheel_forces [{min, max}, ...]}: with it, the defaults of draws and
///   judged_draws are rounded up to a multiple of the number of combinations,
///   goals [{at_most {FIGURE: limit, ...}, share (0.95), mode, soft (false)}, ...],
///   global_evaluations, local_evaluations, seed, scenarios [path relative to the file, ...].
/// Errors (input): those of read_json_file() and read_scenario(); unknown keys; values out of
/// range.
Result<TuneConfig> read_tune_config(const std::filesystem::path& path);

/// Checks that the user's choice on observers (choose_observer()) does not contradict tune.json.
/// `options`: as read from the file. `place`: place of the choice, for the error. Errors (input,
/// `conflict`): the choice is an observer and the file has `no_observer`, or the choice is no
/// observer and the file has `observer`.
Status check_observer_choice(std::optional<bool> observer, const TuneOptions& options,
                             const std::string& place);

/// Checks that the user's choice of a mode, or of one set of gains for all modes, does not
/// contradict tune.json. `options`: as read from the file. Errors (input, `conflict`): the choice
/// is a mode and the file has `one_set`, or the choice is one set and the file has `mode`.
Status check_mode_choice(std::optional<YawMode> mode, bool one_set, const TuneOptions& options);

/// The JSON Schema of tune.json, generated from the code that reads tune.json.
std::string tune_schema();

}  // namespace awmr
