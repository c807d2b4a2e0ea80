/// A part: the directory with the stored results of one shard (shard.h) of a job. Its file
/// shard.json identifies the shard and its origin (options, inputs, program version). Its table
/// (CSV) has the results.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/core/shard.h"

namespace awmr {

class JsonObject;

/// Name of the file that identifies a part.
inline constexpr const char* kShardFile = "shard.json";

/// A kind of job that can be divided into shards.
struct ShardKind {
  const char* schema;  ///< value of the key `schema` in shard.json
  const char* title;   ///< title of the JSON Schema of shard.json
  const char* table;   ///< name of the file with the results
  /// Checks the text of the table before it is written, as ReadBack in file.h. `shard_json`: the
  /// text of the part's shard.json.
  Status (*check)(std::string_view text, const std::string& file, const std::string& shard_json);
  /// Keys of shard.json that may differ between the parts of one job. All other keys that `read`
  /// reads must be equal.
  std::vector<const char*> own_keys;
  const char* arithmetic_advice;  ///< for messages: how to get parts with the same arithmetic
  /// Reads and checks the keys of shard.json that only this kind of job has.
  void (*read)(JsonObject& json);
};

/// Texts of the files of a part.
struct PartText {
  std::string shard_json, table;
};

/// Names of the files of a part, shard.json first.
std::vector<std::string> part_files(const ShardKind& kind);

/// Writes a part into the directory, which is made if necessary. Errors: those of make_directory()
/// and write_files().
Status write_part(const ShardKind& kind, const std::filesystem::path& directory,
                  const PartText& part);

/// The value of the key `schema` in the directory's shard.json, which identifies the kind of job;
/// empty if the key is missing. Errors: those of read_json_file().
Result<std::string> schema_of_part(const std::filesystem::path& directory);

/// JSON Schema of shard.json, derived from its reader.
std::string shard_schema(const ShardKind& kind);

}  // namespace awmr
