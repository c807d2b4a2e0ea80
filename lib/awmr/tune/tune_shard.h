/// Evaluation of gains in parts, on several machines: each searches the gains, with the same
/// result, and runs some of the fresh draws; merge_tune_shards() puts the runs together to the
/// bytes of a single `awmr tune`.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// The `schema` of its shard.json, and what lies next to it: the gains without what fresh draws say of
/// them, and the runs.
inline constexpr std::string_view kTuneShardSchema = "awmr.tune_shard/1";
inline constexpr const char* kTuneShardGains = "gains.json";
inline constexpr const char* kJudgedTable = "judged.csv";

/// The bytes of judged.csv, a row for each run by gains, draw, mode and scenario:
/// `gains,draw,mode,scenario,completed,broke_off` and the figures; scenarios by number, from 1.
/// Precondition: robust gains, tuned with options.shard.
std::string judged_csv(const Tuning& tuning, const TuneOptions& options);

/// The bytes of shard.json: origin and number of the part, the metrics of its runs, and the hashes
/// of the two files next to it.
std::string tune_shard_text(const Tuning& tuning, const TuneOptions& options,
                            const Provenance& provenance);

/// Read-backs of judged.csv and shard.json (core/file.h): that of the table takes the text of its
/// shard.json.
Status check_judged_csv(std::string_view text, const std::string& file,
                        const std::string& shard_json);
Status check_tune_shard_text(std::string_view text, const std::string& file);

/// Whether the directory holds this part already, finished, from the same inputs and options, and as it
/// was written.
bool is_finished_tune_shard(const std::filesystem::path& directory, const Shard& shard,
                            const Provenance& provenance);

/// Result of a single run.
struct MergedTuning {
  std::string gains_text;                               ///< the bytes of gains.json
  std::vector<JudgedGains> judged, judged_by_scenario;  ///< as in RobustTuning
  std::vector<JudgedGoal> goals;
  std::vector<Finding> findings;  ///< those of the evaluation draws, then those of the parts
};

/// Puts the parts in the directories together, in any order. Errors (input): a directory without
/// the three files, or with one that is not the one that shard.json was written with; parts of
/// another kind, or of different searches (inputs, options, version of the program, arithmetic); a
/// part that is missing or there twice; a row that is none of its part's, or missing.
Result<MergedTuning> merge_tune_shards(const std::vector<std::filesystem::path>& directories);

/// The JSON Schema of such a shard.json, from what reads it.
std::string tune_shard_schema();

}  // namespace awmr
