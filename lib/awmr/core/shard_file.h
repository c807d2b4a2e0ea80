/// The files of a part: shard.json says where the part is from and which one it is, and beside it
/// lies a table of what it came to. What all kinds of work have in common. Include from .cpp files
/// only: it brings in nlohmann/json.
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

/// What every shard.json says.
struct ShardOrigin {
  std::filesystem::path directory = {};  ///< that it was read from
  Provenance provenance;
  std::string version = {};  ///< of the program that wrote it
  Shard shard;
  std::string arithmetic;  ///< how its numbers were rounded; "scalar" in files of earlier versions
  std::string csv_sha256 = {};  ///< of the table beside it
  bool stopped = false;         ///< before all of its items were done: it has to be run again
};

/// How shard.json begins.
Json shard_document(std::string_view schema, const ShardOrigin& origin);
/// Reads that back.
ShardOrigin read_shard_origin(JsonObject& json, std::string_view schema);

/// The schema of the part in the directory, by which one kind is told from another; empty where the
/// file names none. Errors: as read_json_file().
Result<std::string> schema_of_part(const std::filesystem::path& directory);

/// DIR/shard.json. Errors: as read_json_file(); (input) it is a part of another kind of work.
Result<Json> read_shard_json(const std::filesystem::path& directory, std::string_view schema);

/// The table beside it. Errors: as read_file(); (input) it is not the one that shard.json was
/// written with.
Result<std::string> read_shard_table(const ShardOrigin& origin, std::string_view name);

/// Whether the directory holds this very part, finished: shard.json as it would be written now, its
/// csv_sha256 that of the table beside it.
bool is_finished_part(const std::filesystem::path& directory, std::string_view schema,
                      const ShardOrigin& origin, std::string_view table);

/// Of the same work, each part once and none missing. `why_not` says in words what else keeps a part
/// from the first one; empty where nothing does. Errors (input), each by its place: another version of
/// the program, number of parts, option or input; a part that was stopped, is there twice, or missing.
Status check_parts(const std::vector<ShardOrigin>& parts,
                   const std::function<std::string(std::size_t)>& why_not);

/// The options that one of them has and the other has not, or has otherwise, by their marked names
/// (option_text.h).
std::string differing_options(const std::vector<std::pair<std::string, std::string>>& a,
                              const std::vector<std::pair<std::string, std::string>>& b);

/// Words for `why_not`: other options; and where numbers were rounded in another way, which parts
/// that are mixed must not be, with what to do about it.
std::string made_with_other_options(const ShardOrigin& first);
std::string other_arithmetic(const ShardOrigin& first, const ShardOrigin& part,
                             std::string_view advice);

/// The parts in the directories as `read` finds them (it takes the JsonObject of shard.json and gives
/// a value with a ShardOrigin `origin`), checked by check_parts() with `why_not(first, part)`, in the
/// order of their numbers.
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
