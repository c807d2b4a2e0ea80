#include "awmr/core/files/shard_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "awmr/core/file.h"
#include "awmr/core/files/hash.h"
#include "awmr/core/json/json_document.h"
#include "awmr/core/option_text.h"

namespace awmr {
namespace {

constexpr long kMaxShards = 1'000'000;

/// Key of the table's SHA-256 in shard.json.
constexpr const char* kHashKey = "csv_sha256";

/// Reads shard.json: the keys that all kinds of job have, then the keys of this kind of job.
PartOrigin read_part(const ShardKind& kind, JsonObject& json) {
  json.schema(kind.schema);
  PartOrigin origin{
      .provenance = read_provenance(json),
      .shard = {.index = static_cast<int>(json.integer("shard_index", 1, kMaxShards)),
                .count = static_cast<int>(json.integer("shard_count", 1, kMaxShards))},
      .arithmetic = json.optional_string("arithmetic").value_or("scalar"),
      .version = json.string("version")};
  json.string(kHashKey);
  json.ignore("command");
  json.ignore("stopped");  // only in files of older versions
  kind.read(json);
  json.reject_unknown_keys();
  return origin;
}

/// The value of the key `schema`; empty if there is none.
std::string schema_in(const Json& document) {
  if (!document.is_object()) return {};
  const auto schema = document.find("schema");
  return schema != document.end() && schema->is_string() ? schema->get<std::string>() : "";
}

Result<Json> read_shard_json(const std::filesystem::path& directory) {
  AWMR_RETURN_IF_ERROR(check_regular_file(directory / kShardFile));
  return read_json_file(directory / kShardFile);
}

Result<Part> read_part(const ShardKind& kind, const std::filesystem::path& directory) {
  const std::string place = (directory / kShardFile).string();
  Part part{.directory = directory, .json = {}, .origin = {}};
  AWMR_ASSIGN_OR_RETURN(part.json, read_shard_json(directory));
  const std::string found = schema_in(part.json);
  if (!found.empty() && found != kind.schema) {
    return input_error(ErrorCode::kStaleResult, place + ":/schema",
                       fmt::format("expected \"{}\", found \"{}\": this is a part of another kind "
                                   "of job; merge each kind separately",
                                   kind.schema, found));
  }
  AWMR_ASSIGN_OR_RETURN(part.origin, read_json_object(part.json, place, [&](JsonObject& json) {
                          return read_part(kind, json);
                        }));
  return part;
}

/// shard.json without the keys that may differ between the parts of one job.
Json shared_keys(const ShardKind& kind, Json json) {
  for (const char* key : {"shard_index", "stopped", "arithmetic", kHashKey}) json.erase(key);
  for (const char* key : kind.own_keys) json.erase(key);
  return json;
}

/// Names of the (name, value) pairs that are in only one of the two lists.
std::set<std::string> differing(const std::vector<std::pair<std::string, std::string>>& a,
                                const std::vector<std::pair<std::string, std::string>>& b) {
  std::set<std::string> names;
  for (const auto& [own, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const auto& one : *own) {
      if (std::ranges::find(*other, one) == other->end()) names.insert(one.first);
    }
  }
  return names;
}

/// The inputs as (name, hash).
std::vector<std::pair<std::string, std::string>> inputs_of(const Provenance& provenance) {
  std::vector<std::pair<std::string, std::string>> inputs;
  for (const InputFile& input : provenance.inputs) inputs.emplace_back(input.name, input.sha256);
  return inputs;
}

/// Describes, for a message, the first difference between the origins of two parts of a job:
/// program version, options or inputs. Empty if there is none. `found`, `found_version`: origin and
/// program version of one part. `expected`: origin of the other part, which the text calls `name`.
/// The part's version must equal the version of this program.
std::string origin_difference(const Provenance& found, const std::string& found_version,
                              const Provenance& expected, const std::string& name) {
  if (found_version != version()) {
    return fmt::format(
        "this part was written by version {} of the program, but this program has version {}; run "
        "the part again with this program",
        found_version, version());
  }
  std::set<std::string> options;
  for (const std::string& option : differing(found.options, expected.options)) {
    options.insert(option_text(option));
  }
  if (!options.empty()) {
    return fmt::format(
        "the options of this part ({}) differ from those of {}; run both parts with the "
        "same options",
        fmt::join(options, ", "), name);
  }
  const auto inputs = inputs_of(found), expected_inputs = inputs_of(expected);
  if (inputs == expected_inputs) return {};
  const std::set<std::string> files = differing(inputs, expected_inputs);
  return files.empty() ? fmt::format(
                             "this part was made from the same inputs as {} in another order; run "
                             "this part again with the same order",
                             name)
                       : fmt::format(
                             "the inputs of this part ({}) differ from those of {}; run both parts "
                             "with the same inputs",
                             fmt::join(files, ", "), name);
}

/// Describes why `part` cannot be combined with `first`, the first part of the job; empty if it
/// can.
std::string difference(const ShardKind& kind, const Part& first, const Part& part) {
  const std::string name = first.directory.string();
  const Shard& shard = part.origin.shard;
  if (shard.count != first.origin.shard.count) {
    return fmt::format("this is one of {} parts, but {} is one of {}; give the parts of one job",
                       shard.count, name, first.origin.shard.count);
  }
  if (shard.index > shard.count) {
    return fmt::format(
        "this is part {} of {}, but a part's number is at most the number of parts; run "
        "the part again",
        shard.index, shard.count);
  }
  const std::string other =
      origin_difference(part.origin.provenance, part.origin.version, first.origin.provenance, name);
  if (!other.empty()) return other;
  if (part.origin.arithmetic != first.origin.arithmetic) {
    return fmt::format(
        "this part was computed in {} arithmetic, but {} in {}: their numbers are rounded "
        "differently; {}",
        part.origin.arithmetic, name, first.origin.arithmetic, kind.arithmetic_advice);
  }
  if (shared_keys(kind, part.json) != shared_keys(kind, first.json)) {
    return fmt::format(
        "the options of this part differ from those of {}; run both parts with the same "
        "options",
        name);
  }
  return {};
}

/// The indices of missing shards, at most the first 20.
std::vector<int> missing_of(const std::map<int, const Part*>& by_index, int count) {
  constexpr std::size_t kNamed = 20;
  std::vector<int> missing;
  for (int i = 1; i <= count && missing.size() < kNamed; ++i) {
    if (!by_index.contains(i)) missing.push_back(i);
  }
  return missing;
}

Status check_parts(const ShardKind& kind, const std::vector<Part>& parts) {
  std::vector<Fault> faults;
  std::map<int, const Part*> by_index;
  for (const Part& part : parts) {
    std::string why = difference(kind, parts.front(), part);
    const Shard& shard = part.origin.shard;
    if (why.empty()) {
      const auto [there, is_new] = by_index.emplace(shard.index, &part);
      if (is_new) continue;
      why = fmt::format("this is part {} of {}, and so is {}; give each part once", shard.index,
                        shard.count, there->second->directory.string());
    }
    faults.push_back(
        {ErrorCode::kStaleResult, (part.directory / kShardFile).string(), std::move(why)});
  }
  const int count = parts.front().origin.shard.count;
  const std::vector<int> missing = missing_of(by_index, count);
  if (faults.empty() && !missing.empty()) {
    faults.push_back({ErrorCode::kMissing, "",
                      fmt::format("of {} parts, these are missing: {}; give their directories too",
                                  count, fmt::join(missing, ", "))});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

}  // namespace

PartText part_text(const ShardKind& kind, const PartOrigin& origin, std::string table,
                   const Json& payload) {
  Json json = output_document(kind.schema, origin.provenance);
  json["shard_index"] = origin.shard.index;
  json["shard_count"] = origin.shard.count;
  json["arithmetic"] = origin.arithmetic;
  json[kHashKey] = sha256_hex(table);
  json.update(payload);
  return {.shard_json = to_text(json), .table = std::move(table)};
}

std::vector<std::string> part_files(const ShardKind& kind) { return {kShardFile, kind.table}; }

Status write_part(const ShardKind& kind, const std::filesystem::path& directory,
                  const PartText& part) {
  // shard.json is written last, because it has the hash of the table.
  const OutputFile files[] = {{directory / kind.table, part.table,
                               [&](std::string_view text, const std::string& file) {
                                 return kind.check(text, file, part.shard_json);
                               }},
                              {directory / kShardFile, part.shard_json,
                               [&](std::string_view text, const std::string& file) {
                                 return check_json_object(text, file, [&](JsonObject& json) {
                                   return read_part(kind, json);
                                 });
                               }}};
  AWMR_RETURN_IF_ERROR(make_directory(directory));
  return write_files(files);
}

Result<std::string> schema_of_part(const std::filesystem::path& directory) {
  AWMR_ASSIGN_OR_RETURN(const Json document, read_shard_json(directory));
  return schema_in(document);
}

std::string shard_schema(const ShardKind& kind) {
  return json_schema_text(kind.schema, kind.title,
                          [&](JsonObject& json) { read_part(kind, json); });
}

Result<std::vector<Part>> read_parts(const ShardKind& kind,
                                     const std::vector<std::filesystem::path>& directories) {
  if (directories.empty()) {
    return input_error(ErrorCode::kMissing, "",
                       "no directories: give the directories of all parts");
  }
  std::vector<Part> parts;
  for (const std::filesystem::path& directory : directories) {
    AWMR_ASSIGN_OR_RETURN(Part part, read_part(kind, directory));
    parts.push_back(std::move(part));
  }
  AWMR_RETURN_IF_ERROR(check_parts(kind, parts));
  std::ranges::sort(parts, {}, [](const Part& part) { return part.origin.shard.index; });
  return parts;
}

Result<std::string> read_table(const ShardKind& kind, const Part& part) {
  const std::filesystem::path path = part.directory / kind.table;
  AWMR_RETURN_IF_ERROR(check_regular_file(path));
  AWMR_ASSIGN_OR_RETURN(std::string text, read_file(path));
  if (part.json.at(kHashKey) != Json(sha256_hex(text))) {
    return input_error(ErrorCode::kStaleResult, path.string(),
                       fmt::format("this table is not as it was written with {}: it was changed "
                                   "or cut off; run the part again",
                                   kShardFile));
  }
  return text;
}

Status check_items(const ShardKind& kind, const Part& part, std::string_view name, int items,
                   std::size_t rows, const std::function<int(std::size_t)>& item_of) {
  const std::string place = (part.directory / kind.table).string();
  const Shard& shard = part.origin.shard;
  if (const auto fault = shard_fault(shard, items, fmt::format("{}s", name))) {
    return input_error(ErrorCode::kStaleResult, (part.directory / kShardFile).string(),
                       fault->message);
  }
  const std::size_t share = at(shard.share_of(items));
  for (std::size_t i = 0; i < rows; ++i) {
    const int expected = shard.item(static_cast<int>(i % share));
    if (item_of(i) == expected) continue;
    return input_error(
        ErrorCode::kStaleResult, place,
        fmt::format("row {} has {} {}, but {} is expected: rows are missing, repeated or from "
                    "another part; run part {} of {} again",
                    i + 1, name, item_of(i), expected, shard.index, shard.count));
  }
  if (rows > 0 && rows % share == 0) return {};
  return input_error(
      ErrorCode::kStaleResult, place,
      fmt::format("the table has {} rows, not a multiple of the {} {}s of part {} of {}: rows "
                  "are missing or repeated; run the part again",
                  rows, share, name, shard.index, shard.count));
}

}  // namespace awmr
