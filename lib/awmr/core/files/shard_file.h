/// Reads parts, the stored results of shards (shard_kind.h), and combines the parts of one job.
/// Include this header from .cpp files only, because nlohmann/json is slow to compile.
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
#include "awmr/core/json/json.h"
#include "awmr/core/shard_kind.h"

namespace awmr {

/// Origin of a part: the keys that every shard.json has, except the hash of the table.
struct PartOrigin {
  Provenance provenance;
  Shard shard;
  /// How numbers were rounded, "fused" or "scalar"; all parts of a job must agree. Files without
  /// this key count as "scalar".
  std::string arithmetic;
  std::string version = {};  ///< version of the program that wrote the part
};

/// Returns the texts of a part's files. `payload`: additional keys of shard.json for this kind of
/// job.
PartText part_text(const ShardKind& kind, const PartOrigin& origin, std::string table,
                   const Json& payload);

/// A part that was read.
struct Part {
  std::filesystem::path directory;
  Json json;          ///< the document shard.json, whose keys were checked
  PartOrigin origin;  ///< the common keys of shard.json
};

/// Reads the parts in the directories, checks that they are all parts of one job, and returns them
/// by shard index. Errors (input): a part that is missing or given twice; parts that differ in
/// kind, program version, number of parts, options, inputs, rounding of numbers, or in other keys
/// that must agree.
Result<std::vector<Part>> read_parts(const ShardKind& kind,
                                     const std::vector<std::filesystem::path>& directories);

/// Reads keys of a shard.json that was already checked: returns the result of `read(JsonObject&)`.
template <class Read>
auto payload_of(const Json& shard_json, const Read& read) {
  std::vector<Fault> faults;
  JsonObject json(shard_json, kShardFile, "", faults);
  return read(json);
}

/// Reads the table of a part. Errors: those of read_file(); (input) the hash of the table differs
/// from the hash in shard.json.
Result<std::string> read_table(const ShardKind& kind, const Part& part);

/// Checks that the rows of a part's table belong to this part: all items of the part in order, once
/// or several times. `items`: number of items of the whole job. `rows`: number of rows.
/// `item_of(i)`: item of row i. `name`: what an item is, such as "run". Errors (input): the shard
/// does not fit a job of `items` items; the table has no rows; a row belongs to another item; rows
/// are missing or repeated.
Status check_items(const ShardKind& kind, const Part& part, std::string_view name, int items,
                   std::size_t rows, const std::function<int(std::size_t)>& item_of);

/// Merges the rows of all parts into the order that a job without shards has. `parts`: rows of each
/// part, by shard index, in one or more blocks. A block has one row for each item of the part, in
/// order. `items`: number of items of the whole job. Errors (input): the parts have different
/// numbers of blocks.
template <class Row>
Result<std::vector<Row>> in_order_of_items(const std::vector<std::vector<Row>>& parts, int items) {
  std::size_t rows = 0;
  for (const std::vector<Row>& part : parts) rows += part.size();
  std::vector<Row> all;
  std::vector<std::size_t> next(parts.size());
  while (all.size() < rows) {
    for (std::size_t item = 0; item < at(items); ++item) {
      const std::vector<Row>& part = parts[item % parts.size()];
      std::size_t& row = next[item % parts.size()];
      if (row == part.size()) {
        return input_error(
            ErrorCode::kStaleResult, "",
            fmt::format("part {} of {} has fewer rows for each of its runs or samples than another "
                        "part: it has lost rows, or the other part has rows twice; run all parts "
                        "again",
                        item % parts.size() + 1, parts.size()));
      }
      all.push_back(part[row++]);
    }
  }
  return all;
}

}  // namespace awmr
