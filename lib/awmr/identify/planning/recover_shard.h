/// Recovery on several machines, each of which does some of the runs. merge_recover_shards()
/// combines the parts to the output of a single recovery, byte for byte.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard_kind.h"
#include "awmr/identify/planning/recover_part.h"

namespace awmr {

/// Files of a part: recovery.csv has a row per run.
const ShardKind& recover_shards();

/// The files of the part `shard`.
PartText recover_part_text(const RecoverPart& part, const Shard& shard,
                           const Provenance& provenance);

/// All runs, with the content of recover.json.
struct MergedRecovery {
  RecoverPart whole;
  Provenance provenance;
};

/// Combines the parts in these directories, in any order. Errors (input): as read_parts(); a row of
/// another part, or a missing row.
Result<MergedRecovery> merge_recover_shards(const std::vector<std::filesystem::path>& directories);

}  // namespace awmr
