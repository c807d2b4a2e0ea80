/// Comparison on several machines: each machine runs a part (shard) of the samples. merge_shards()
/// combines the parts; the output files equal those of an undivided comparison, byte for byte.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard_kind.h"
#include "awmr/model/record.h"

namespace awmr {

/// Files of a part of a comparison: shard.json, and comparison.csv with the part's samples.
const ShardKind& comparison_shards();

/// Returns the texts of the files of one part, which options.shard selects.
PartText comparison_part(const Comparison& part, const CompareOptions& options,
                         const Provenance& provenance, const std::vector<Finding>& findings = {});

/// Result of merge_shards(): the whole comparison, with the data that its output files need.
struct Merged {
  Comparison comparison;
  /// Options of the parts; only samples, seed and preferences are set
  CompareOptions options;
  Provenance provenance;
  /// completion_findings() and extrapolation_findings() of all runs, then findings of part 1.
  std::vector<Finding> findings;
};

/// Combines the parts in these directories, in any order. Errors (input): those of read_parts(); a
/// row is invalid, belongs to another part, is missing or appears twice.
Result<Merged> merge_shards(const std::vector<std::filesystem::path>& directories);

}  // namespace awmr
