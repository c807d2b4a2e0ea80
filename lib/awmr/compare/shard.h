/// Comparison on several machines: each runs a part of the samples, and merge_shards() combines the
/// parts to the output of a single comparison, byte for byte.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard_kind.h"
#include "awmr/model/record.h"

namespace awmr {

/// Files of one part (shard) of a comparison: comparison.csv has the rows of its samples.
const ShardKind& comparison_shards();

/// Text of the part of a comparison that options.shard selects.
PartText comparison_part(const Comparison& part, const CompareOptions& options,
                         const Provenance& provenance, const std::vector<Finding>& findings = {});

/// A whole comparison with the data that its files need.
struct Merged {
  Comparison comparison;
  CompareOptions options;  ///< samples, seed and preferences
  Provenance provenance;
  /// extrapolation_findings() of all runs, then the findings of the first part.
  std::vector<Finding> findings;
};

/// Combines the parts in these directories, in any order. Errors (input): as read_parts(); a row of
/// another part, or a missing row.
Result<Merged> merge_shards(const std::vector<std::filesystem::path>& directories);

}  // namespace awmr
