/// Evaluation of gains in parts, on several machines: each searches the gains, with the same
/// result, and runs some of the fresh draws; merge_tune_shards() puts the runs together to the
/// bytes of a single `awmr tune`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard_kind.h"
#include "awmr/tune/tune.h"

namespace awmr {

/// Parts of a tuning: judged.csv has a row for each run by gains, draw, mode and scenario;
/// gains.json the gains without what fresh draws say of them.
const ShardKind& tune_shards();

/// The part of a tuning that options.shard is. Precondition: robust gains, tuned with that.
PartText tune_part(const Tuning& tuning, const TuneOptions& options, const Provenance& provenance,
                   const std::vector<Finding>& findings = {});

/// The result that a single run without parts has.
struct MergedTuning {
  std::string gains_text;                                        ///< the bytes of gains.json
  std::vector<EvaluatedGains> evaluated, evaluated_by_scenario;  ///< as in RobustTuning
  std::vector<EvaluatedGoal> goals;
  std::vector<Finding> findings;  ///< of the evaluation draws, then of the first part
};

/// Puts the parts in the directories together, in any order. Errors (input): as read_parts(); a file
/// that is not the one that shard.json was written with; a row of another part, or
/// missing.
Result<MergedTuning> merge_tune_shards(const std::vector<std::filesystem::path>& directories);

}  // namespace awmr
