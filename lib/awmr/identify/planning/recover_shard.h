/// A recovery in parts, for several machines: each has some of the runs, and merge_recover_shards()
/// puts them together to the bytes of a single run.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard_kind.h"
#include "awmr/identify/planning/recover_part.h"

namespace awmr {

/// Parts of a recovery: recovery.csv has a row for each run.
const ShardKind& recover_shards();

/// The part of a recovery that `shard` is.
PartText recover_part_text(const RecoverPart& part, const Shard& shard,
                           const Provenance& provenance);

/// All runs, with what recover.json is written from.
struct MergedRecovery {
  RecoverPart whole;
  Provenance provenance;
};

/// Puts the parts in the directories together, in any order. Errors (input): as read_parts(); a row
/// of another part, or missing.
Result<MergedRecovery> merge_recover_shards(const std::vector<std::filesystem::path>& directories);

}  // namespace awmr
