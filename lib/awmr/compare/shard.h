/// A comparison in parts, for several machines: each runs some of the samples, and merge_shards()
/// puts them together to the bytes of a single run.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard_kind.h"
#include "awmr/model/record.h"

namespace awmr {

/// Parts of a comparison: comparison.csv has the rows.
const ShardKind& comparison_shards();

/// Text of the part of a comparison that options.shard selects.
PartText comparison_part(const Comparison& part, const CompareOptions& options,
                         const Provenance& provenance, const std::vector<Finding>& findings = {});

/// A whole comparison with the data for its files.
struct Merged {
  Comparison comparison;
  CompareOptions options;  ///< samples, seed and preferences
  Provenance provenance;
  std::vector<Finding> findings;  ///< of the fastest turn of all runs, then of the first part
};

/// Puts the parts in the directories together, in any order. Errors (input): as read_parts(); a row
/// of another part, or missing.
Result<Merged> merge_shards(const std::vector<std::filesystem::path>& directories);

}  // namespace awmr
