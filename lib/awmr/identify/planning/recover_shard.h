/// Files of `awmr recover --shard`, with which several machines divide the runs among themselves.
/// merge_recover_shards() combines the parts; the result is byte for byte that of a single machine.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard_kind.h"
#include "awmr/identify/planning/recover_part.h"

namespace awmr {

/// Description of the files of a part: shard.json, and recovery.csv with a row per run.
const ShardKind& recover_shards();

/// Texts of the files of the part `shard`: shard.json and recovery.csv.
PartText recover_part_text(const RecoverPart& part, const Shard& shard,
                           const Provenance& provenance);

/// All runs of the merged parts, with the provenance for recover.json.
struct MergedRecovery {
  RecoverPart whole;
  Provenance provenance;
};

/// Combines the parts in these directories, in any order. Errors (input): those of read_parts(); a
/// row that belongs to another part; a missing row.
Result<MergedRecovery> merge_recover_shards(const std::vector<std::filesystem::path>& directories);

}  // namespace awmr
