/// Files of a shard, common to all kinds of jobs: shard.json identifies the shard and its origin; a
/// table next to it has the results. Include from .cpp files only, because it includes
/// nlohmann/json.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/json.h"
#include "awmr/core/shard.h"

namespace awmr {

/// Contents common to every shard.json.
struct ShardOrigin {
  std::filesystem::path directory = {};  ///< the shard was read from here
  Provenance provenance;
  std::string version = {};  ///< of the program that wrote it
  Shard shard;
  std::string arithmetic;       ///< rounding of its numbers; "scalar" in files of earlier versions
  std::string csv_sha256 = {};  ///< of the table next to it
  bool stopped = false;         ///< stopped before all items were done: must be run again
};

/// Beginning of shard.json.
Json shard_document(std::string_view schema, const ShardOrigin& origin);
/// Reads the keys written by shard_document().
ShardOrigin read_shard_origin(JsonObject& json, std::string_view schema);

/// The schema of the shard in the directory, which identifies its kind; empty if the file names
/// none. Errors: as read_json_file().
Result<std::string> schema_of_part(const std::filesystem::path& directory);

/// Reads DIR/shard.json. Errors: as read_json_file(); (input) it is a shard of another kind of job.
Result<Json> read_shard_json(const std::filesystem::path& directory, std::string_view schema);

/// Reads the table next to shard.json. Errors: as read_file(); (input) its hash differs from the
/// one in shard.json.
Result<std::string> read_shard_table(const ShardOrigin& origin, std::string_view name);

/// True if the directory holds this shard, finished: shard.json is as it would be written now, and
/// its csv_sha256 is that of the table next to it.
bool is_finished_part(const std::filesystem::path& directory, std::string_view schema,
                      const ShardOrigin& origin, std::string_view table);

/// Checks that the shards are of one job, each exactly once and none missing. `why_not` returns any
/// other reason why a shard does not match the first, or an empty text. Errors (input), each with
/// its place: another program version, number of shards, option or input; a shard that is stopped,
/// duplicate or missing.
Status check_parts(const std::vector<ShardOrigin>& parts,
                   const std::function<std::string(std::size_t)>& why_not);

/// Options that differ or exist in only one of the lists, by their marked names (option_text.h).
std::string differing_options(const std::vector<std::pair<std::string, std::string>>& a,
                              const std::vector<std::pair<std::string, std::string>>& b);

/// Texts for `why_not`: other options; numbers rounded in another way, which cannot be mixed, with
/// the remedy.
std::string made_with_other_options(const ShardOrigin& first);
std::string other_arithmetic(const ShardOrigin& first, const ShardOrigin& part,
                             std::string_view advice);

/// Reads the shards in the directories with `read`, which takes the JsonObject of shard.json and
/// returns a value with a ShardOrigin `origin`. Checks them by check_parts() with `why_not(first,
/// part)`; returns them in order of their numbers.
template <class Read, class WhyNot>
auto read_parts(const std::vector<std::filesystem::path>& directories, std::string_view schema,
                const Read& read, const WhyNot& why_not)
    -> Result<std::vector<decltype(read(std::declval<JsonObject&>()))>> {
  if (directories.empty()) return input_error("", "no directories: give those of all parts");
  std::vector<decltype(read(std::declval<JsonObject&>()))> parts;
  std::vector<ShardOrigin> origins;
  for (const std::filesystem::path& directory : directories) {
    AWMR_ASSIGN_OR_RETURN(const Json document, read_shard_json(directory, schema));
    std::vector<Fault> faults;
    JsonObject json(document, (directory / kShardFile).string(), "", faults);
    parts.push_back(read(json));
    if (!faults.empty()) return input_errors(std::move(faults));
    parts.back().origin.directory = directory;
    origins.push_back(parts.back().origin);
  }
  AWMR_RETURN_IF_ERROR(
      check_parts(origins, [&](std::size_t i) { return why_not(parts.front(), parts[i]); }));
  std::sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
    return a.origin.shard.index < b.origin.shard.index;
  });
  return parts;
}

}  // namespace awmr
