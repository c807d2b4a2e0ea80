/// Evaluation of tuned gains on several machines. Each machine repeats the search, with the same
/// result, and simulates its part of the new draws. merge_tune_shards() combines the parts to the
/// output of a single `awmr tune`, byte for byte.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard_kind.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Files of one part (shard) of a tuning, in addition to shard.json: judged.csv has a row for each
/// run of its draws, by gains, draw, mode and scenario; gains.json has the gains without their
/// evaluation on new draws.
const ShardKind& tune_shards();

/// Text of the files of the part `options.shard`. Precondition: `tuning` is the result of a robust
/// search with these options.
PartText tune_part(const Tuning& tuning, const TuneOptions& options, const Provenance& provenance,
                   const std::vector<Finding>& findings = {});

/// Result of all parts together, equal to that of a single `awmr tune`.
struct MergedTuning {
  std::string gains_text;                                        ///< the bytes of gains.json
  std::vector<EvaluatedGains> evaluated, evaluated_by_scenario;  ///< as in RobustTuning
  std::vector<EvaluatedGoal> goals;
  std::vector<Finding> findings;  ///< those of the evaluation draws, then those of the first part
};

/// Combines the parts in these directories, in any order. Errors (input): as read_parts(); a file
/// whose checksum differs from the one in shard.json; a row of another part, or a missing row; a
/// gains.json without `robust`.
Result<MergedTuning> merge_tune_shards(const std::vector<std::filesystem::path>& directories);

}  // namespace awmr
