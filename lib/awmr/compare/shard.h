/// A comparison in parts, on as many machines: each runs some of the samples, merge_shards() puts
/// them together to the bytes of a single run.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr {

/// The bytes of shard.json, which lies next to the part's comparison.csv: where the part is from,
/// which one it is, and the hash of its rows.
std::string shard_text(const Comparison& part, const CompareOptions& options,
                       const Provenance& provenance);

/// Read-back of shard.json (core/file.h).
Status check_shard_text(std::string_view text, const std::string& file);

/// Whether the directory holds this part already, finished, from the same inputs and options, and as
/// it was written.
bool is_finished_shard(const std::filesystem::path& directory, const CompareOptions& options,
                       const Provenance& provenance);

/// A whole comparison with what its files are written from.
struct Merged {
  Comparison comparison;
  CompareOptions options;  ///< samples and seed
  Provenance provenance;
  std::vector<Finding>
      findings;  ///< those of the fastest turn of all runs, then those of the parts
};

/// Puts the parts in the directories together, in any order. Errors (input): a directory without
/// shard.json and comparison.csv, or with rows that are not those that shard.json was written with;
/// parts of different comparisons (inputs, options, version of the program); a part that is missing
/// or there twice, each by its number; one that was stopped.
Result<Merged> merge_shards(const std::vector<std::filesystem::path>& directories);

/// The JSON Schema of shard.json, from what reads it.
std::string shard_schema();

}  // namespace awmr
