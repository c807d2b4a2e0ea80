#include "awmr/core/shard_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>

#include "awmr/core/file.h"
#include "awmr/core/hash.h"
#include "awmr/core/option_text.h"

namespace awmr {
namespace {

/// Maximum number of shards: far above any cluster.
constexpr long kMostShards = 1'000'000;

std::string file_of(const ShardOrigin& part) { return (part.directory / kShardFile).string(); }

/// Reason why a shard is not of the same job as the first; empty if it is.
std::string other_work(const ShardOrigin& first, const ShardOrigin& part) {
  const auto same_input = [](const InputFile& a, const InputFile& b) {
    return a.name == b.name && a.sha256 == b.sha256;
  };
  const auto& a = first.provenance;
  const auto& b = part.provenance;
  if (part.version != version()) {
    return fmt::format("was made by version {} of the program, this is {}", part.version,
                       version());
  }
  if (part.shard.count != first.shard.count) {
    return fmt::format("is one of {} parts, {} is one of {}", part.shard.count,
                       first.directory.string(), first.shard.count);
  }
  if (part.shard.index > part.shard.count) {
    return fmt::format("is part {} of {}: there is none", part.shard.index, part.shard.count);
  }
  if (a.options != b.options) {
    return fmt::format("{} ({})", made_with_other_options(first),
                       differing_options(a.options, b.options));
  }
  if (!std::equal(a.inputs.begin(), a.inputs.end(), b.inputs.begin(), b.inputs.end(), same_input)) {
    return fmt::format("was made from other inputs than {}", first.directory.string());
  }
  if (part.stopped) return "was stopped before its end: run it again";
  return {};
}

/// Empty if the file names none.
std::string schema_in(const Json& document) {
  if (!document.is_object()) return {};
  const auto schema = document.find("schema");
  return schema != document.end() && schema->is_string() ? schema->get<std::string>() : "";
}

/// The lowest numbers of missing shards.
std::vector<int> missing_of(const std::map<int, const ShardOrigin*>& by_index, int count) {
  constexpr std::size_t kNamed = 20;
  std::vector<int> missing;
  for (int i = 1; i <= count && missing.size() < kNamed; ++i) {
    if (by_index.count(i) == 0) missing.push_back(i);
  }
  return missing;
}

}  // namespace

Json shard_document(std::string_view schema, const ShardOrigin& origin) {
  Json json = output_document(schema, origin.provenance);
  json["shard_index"] = origin.shard.index;
  json["shard_count"] = origin.shard.count;
  json["arithmetic"] = origin.arithmetic;
  json["csv_sha256"] = origin.csv_sha256;
  json["stopped"] = origin.stopped;
  return json;
}

ShardOrigin read_shard_origin(JsonObject& json, std::string_view schema) {
  json.schema(schema);
  ShardOrigin origin{
      .provenance = read_provenance(json),
      .version = json.string("version"),
      .shard = {.index = static_cast<int>(json.integer("shard_index", 1, kMostShards)),
                .count = static_cast<int>(json.integer("shard_count", 1, kMostShards))},
      .arithmetic = json.optional_string("arithmetic").value_or("scalar"),
      .csv_sha256 = json.string("csv_sha256"),
      .stopped = json.boolean("stopped")};
  json.ignore("command");
  return origin;
}

Result<std::string> schema_of_part(const std::filesystem::path& directory) {
  AWMR_RETURN_IF_ERROR(check_regular_file(directory / kShardFile));
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_file(directory / kShardFile));
  return schema_in(document);
}

Result<Json> read_shard_json(const std::filesystem::path& directory, std::string_view schema) {
  const std::filesystem::path path = directory / kShardFile;
  AWMR_RETURN_IF_ERROR(check_regular_file(path));
  AWMR_ASSIGN_OR_RETURN(Json document, read_json_file(path));
  const std::string found = schema_in(document);
  if (!found.empty() && found != schema) {
    return input_error(path.string() + ":/schema",
                       fmt::format("expected \"{}\", found \"{}\": this is a part of another kind "
                                   "of work; merge each kind by itself",
                                   schema, found));
  }
  return document;
}

Result<std::string> read_shard_table(const ShardOrigin& origin, std::string_view name) {
  const std::filesystem::path path = origin.directory / name;
  AWMR_RETURN_IF_ERROR(check_regular_file(path));
  AWMR_ASSIGN_OR_RETURN(std::string text, read_file(path));
  if (sha256_hex(text) != origin.csv_sha256) {
    return input_error(path.string(),
                       fmt::format("is not as it was written with {}: it was changed "
                                   "or cut off; run the part again",
                                   kShardFile));
  }
  return text;
}

bool is_finished_part(const std::filesystem::path& directory, std::string_view schema,
                      const ShardOrigin& origin, std::string_view table) {
  if (!check_regular_file(directory / kShardFile) || !check_regular_file(directory / table)) {
    return false;
  }
  const auto found = read_json_file(directory / kShardFile);
  const auto text = read_file(directory / table);
  if (!found || !text || !found->is_object()) return false;
  ShardOrigin finished = origin;
  finished.csv_sha256 = sha256_hex(*text);
  const Json expected = shard_document(schema, finished);
  for (const auto& [key, value] : expected.items()) {
    const auto there = found->find(key);
    if (there == found->end() || *there != value) return false;
  }
  return true;
}

std::string differing_options(const std::vector<std::pair<std::string, std::string>>& a,
                              const std::vector<std::pair<std::string, std::string>>& b) {
  std::set<std::string> names;
  for (const auto& [own, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const auto& option : *own) {
      if (std::find(other->begin(), other->end(), option) == other->end()) {
        names.insert(option_text(option.first));
      }
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string made_with_other_options(const ShardOrigin& first) {
  return fmt::format("was made with other options than {}", first.directory.string());
}

std::string other_arithmetic(const ShardOrigin& first, const ShardOrigin& part,
                             std::string_view advice) {
  if (part.arithmetic == first.arithmetic) return {};
  return fmt::format(
      "was computed in {} arithmetic, {} in {}: their numbers are rounded differently; {}",
      part.arithmetic, first.directory.string(), first.arithmetic, advice);
}

Status check_parts(const std::vector<ShardOrigin>& parts,
                   const std::function<std::string(std::size_t)>& why_not) {
  std::vector<Fault> faults;
  std::map<int, const ShardOrigin*> by_index;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const ShardOrigin& part = parts[i];
    std::string why = other_work(parts.front(), part);
    if (why.empty()) why = why_not(i);
    if (!why.empty()) {
      faults.push_back({file_of(part), why});
      continue;
    }
    const auto [there, is_new] = by_index.emplace(part.shard.index, &part);
    if (is_new) continue;
    faults.push_back(
        {file_of(part), fmt::format("is part {} of {}, which {} is as well", part.shard.index,
                                    part.shard.count, there->second->directory.string())});
  }
  const int count = parts.front().shard.count;
  const std::vector<int> missing = missing_of(by_index, count);
  if (faults.empty() && !missing.empty()) {
    faults.push_back(
        {"", fmt::format("of {} parts, these are missing: {}", count, fmt::join(missing, ", "))});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

}  // namespace awmr
