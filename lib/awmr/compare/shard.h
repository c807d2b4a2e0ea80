/// Comparison on several machines, each of which runs some of the samples. merge_shards() combines
/// the parts to the output of a single comparison, byte for byte.
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

/// Combines the parts in these directories, in any order. Errors (input): as read_parts(); a row of
/// another part, or a missing row.
Result<Merged> merge_shards(const std::vector<std::filesystem::path>& directories);

}  // namespace awmr
