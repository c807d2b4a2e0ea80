/// The files of a part of a recovery, and the parts of all machines put together to the bytes of a
/// single run.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard.h"
#include "awmr/identify/planning/recover_part.h"

namespace awmr {

/// The `schema` of its shard.json, and the table next to it.
inline constexpr std::string_view kRecoverShardSchema = "awmr.recover_shard/1";
inline constexpr const char* kRecoverTable = "recovery.csv";

/// The bytes of recovery.csv, a row for each run: `run,refused`, and of every parameter that some run
/// gave `NAME,NAME.std_error,NAME.ci95_lo,NAME.ci95_hi`, empty where this run did not.
std::string recover_csv(const RecoverPart& part);

/// The bytes of shard.json, which lies next to it: where the part is from, which one it is, what its
/// runs were simulated with, and the hash of the table.
std::string recover_shard_text(const RecoverPart& part, const Shard& shard,
                               const Provenance& provenance);

/// Read-backs of the two files (core/file.h): that of the table takes the part that it is of.
Status check_recover_csv(std::string_view text, const std::string& file, const RecoverPart& part);
Status check_recover_shard_text(std::string_view text, const std::string& file);

/// Whether the directory holds this part already, finished, from the same inputs and options, and as
/// it was written.
bool is_finished_recover_shard(const std::filesystem::path& directory, const Shard& shard,
                               const Provenance& provenance);

/// All runs, with what recover.json is written from.
struct MergedRecovery {
  RecoverPart whole;
  Provenance provenance;
};

/// Puts the parts in the directories together, in any order. Errors (input): a directory without
/// shard.json and recovery.csv, or with a table that is not the one that shard.json was written with;
/// parts of another kind, or of different recoveries (inputs, options, version of the program,
/// arithmetic); a part that is missing or there twice; a row that is none of its part's, or missing.
Result<MergedRecovery> merge_recover_shards(const std::vector<std::filesystem::path>& directories);

/// The JSON Schema of such a shard.json, from what reads it.
std::string recover_shard_schema();

}  // namespace awmr
