/// Reads and writes the files of a part, and combines the parts of a job. Include from .cpp files
/// only, because it includes nlohmann/json.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "awmr/core/index.h"
#include "awmr/core/json.h"
#include "awmr/core/shard_kind.h"

namespace awmr {

/// Contents common to every shard.json, except the hashes.
struct PartOrigin {
  Provenance provenance;
  Shard shard;
  std::string arithmetic;    ///< rounding of its numbers; "scalar" in files of earlier versions
  bool stopped = false;      ///< stopped before all items were done: must be run again
  std::string version = {};  ///< of the program that wrote it
};

/// The text of a part with these files. `payload` has the keys of ShardKind::read.
PartText part_text(const ShardKind& kind, const PartOrigin& origin, std::vector<std::string> files,
                   const Json& payload);

/// A part, read. Its payload is that of `json`, which ShardKind::read accepts.
struct Part {
  std::filesystem::path directory;
  Json json;  ///< shard.json
  PartOrigin origin;
};

/// Reads the parts in the directories and checks that they are of one job, each exactly once;
/// returns them in order of their numbers. Errors (input), each with its place: a part of another
/// kind, program version, number of parts, option, input, arithmetic or payload; one that is
/// stopped, duplicate or missing.
Result<std::vector<Part>> read_parts(const ShardKind& kind,
                                     const std::vector<std::filesystem::path>& directories);

/// Reads the payload of a valid shard.json by `read`.
template <class Read>
auto payload_of(const Json& shard_json, const Read& read) {
  std::vector<Fault> faults;
  JsonObject json(shard_json, kShardFile, "", faults);
  return read(json);
}

/// Reads a file next to shard.json. Errors: as read_file(); (input) its hash differs from the one
/// in shard.json.
Result<std::string> read_part_file(const Part& part, const ShardFile& file);

/// Checks that the rows of a table are those of the part's items, of `items` in total: each item in
/// order, with one or more consecutive rows. `item_of(i)`: the item of row i. `name`: kind of item,
/// "run". Errors (input): the part has no items; a row is of another item; rows are missing.
Status check_items(const Part& part, const ShardFile& file, std::string_view name, int items,
                   std::size_t rows, const std::function<int(std::size_t)>& item_of);

/// Merges the rows of all parts in the order of a single run. Each part has blocks of the rows of
/// its items in order, `per_item` rows per item. Errors (input): the parts have different numbers
/// of blocks.
template <class Row>
Result<std::vector<Row>> in_order_of_items(const std::vector<std::vector<Row>>& parts, int items,
                                           std::size_t per_item = 1) {
  std::size_t rows = 0;
  for (const std::vector<Row>& part : parts) rows += part.size();
  std::vector<Row> all;
  std::vector<std::size_t> next(parts.size());
  while (all.size() < rows) {
    for (std::size_t item = 0; item < at(items); ++item) {
      const std::vector<Row>& part = parts[item % parts.size()];
      std::size_t& begin = next[item % parts.size()];
      if (part.size() - begin < per_item) {
        return input_error(ErrorCode::kStaleResult, "",
                           fmt::format("part {} of {} has fewer rows than another: it has lost "
                                       "rows, or the other repeats some; run both again",
                                       item % parts.size() + 1, parts.size()));
      }
      all.insert(all.end(), part.begin() + eigen_index(begin),
                 part.begin() + eigen_index(begin + per_item));
      begin += per_item;
    }
  }
  return all;
}

/// Difference between the origins of two results that are to be combined, as text: `found` compared
/// with `expected`, whose name is `name`. Empty if there is none.
std::string origin_difference(const Provenance& found, const std::string& found_version,
                              const Provenance& expected, const std::string& name);

}  // namespace awmr
