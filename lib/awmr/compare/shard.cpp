#include "awmr/compare/shard.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "awmr/compare/resume.h"
#include "awmr/core/hash.h"
#include "awmr/core/index.h"
#include "awmr/core/json.h"

namespace awmr {
namespace {

constexpr std::string_view kShardSchema = "awmr.shard/1";
/// Parts of a comparison, and samples of one, at the most: far beyond any cluster.
constexpr long kMostShards = 1'000'000;
constexpr long kMostSamples = 1'000'000'000;

/// One directory's part.
struct Part {
  std::filesystem::path directory;
  Provenance provenance;
  std::string version;
  int samples = 0;
  std::uint64_t seed = 0;
  Preferences preferences;
  Shard shard;
  bool stopped = false;
  std::string arithmetic;  ///< Comparison::arithmetic; "scalar" in files of earlier versions
  std::string csv_sha256;
};

Preferences read_preferences(JsonObject& json) {
  Preferences preferences;
  preferences.relevance = json.number("relevance", {.min = 0.0, .max = 1.0});
  JsonObject weights = json.object("weights");
  for (const std::string& name : weights.keys()) {
    preferences.weights[name] = weights.number(name, {.min = 0.0, .max = kMaximumWeight});
  }
  return preferences;
}

Part part_from_json(JsonObject& json) {
  json.schema(kShardSchema);
  Part part{
      .directory = {},
      .provenance = read_provenance(json),
      .version = json.string("version"),
      .samples = static_cast<int>(json.integer("samples", 0, kMostSamples)),
      .seed = static_cast<std::uint64_t>(json.integer("seed", 0, std::numeric_limits<long>::max())),
      .preferences = read_preferences(json),
      .shard = {.index = static_cast<int>(json.integer("shard_index", 1, kMostShards)),
                .count = static_cast<int>(json.integer("shard_count", 1, kMostShards))},
      .stopped = json.boolean("stopped"),
      .arithmetic = json.optional_string("arithmetic").value_or("scalar"),
      .csv_sha256 = json.string("csv_sha256")};
  json.ignore("command");
  json.reject_unknown_keys();
  return part;
}

Result<Part> read_part(const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / "shard.json";
  AWMR_ASSIGN_OR_RETURN(const Json document, read_json_file(path));
  std::vector<Fault> faults;
  JsonObject json(document, path.string(), "", faults);
  Part part = part_from_json(json);
  part.directory = directory;
  if (!faults.empty()) return input_errors(std::move(faults));
  return part;
}

/// Why a part is not of the same comparison as the first; empty where it is.
std::string other_comparison(const Part& first, const Part& part) {
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
  if (a.options != b.options || part.samples != first.samples || part.seed != first.seed ||
      part.preferences != first.preferences) {
    return fmt::format("was made with other options than {}", first.directory.string());
  }
  if (!std::equal(a.inputs.begin(), a.inputs.end(), b.inputs.begin(), b.inputs.end(), same_input)) {
    return fmt::format("was made from other inputs than {}", first.directory.string());
  }
  if (part.arithmetic != first.arithmetic) {
    return fmt::format(
        "was computed in {} arithmetic, {} in {}: their processors round "
        "differently; run one of them again, all with AWMR_INSTRUCTIONS=sse2 or all "
        "on processors with fused multiply-add",
        part.arithmetic, first.directory.string(), first.arithmetic);
  }
  if (part.stopped) return "was stopped before its end: run it again";
  return {};
}

/// Each part once, none missing.
Status check_parts(const std::vector<Part>& parts) {
  std::vector<Fault> faults;
  std::map<int, const Part*> by_index;
  for (const Part& part : parts) {
    const std::string place = (part.directory / "shard.json").string();
    if (const std::string why = other_comparison(parts.front(), part); !why.empty()) {
      faults.push_back({place, why});
      continue;
    }
    const auto [there, is_new] = by_index.emplace(part.shard.index, &part);
    if (is_new) continue;
    faults.push_back({place, fmt::format("is part {} of {}, which {} is as well", part.shard.index,
                                         part.shard.count, there->second->directory.string())});
  }
  std::vector<int> missing;
  constexpr std::size_t kNamed = 20;
  for (int i = 1; i <= parts.front().shard.count && missing.size() < kNamed; ++i) {
    if (by_index.count(i) == 0) missing.push_back(i);
  }
  if (faults.empty() && !missing.empty()) {
    faults.push_back({"", fmt::format("of {} parts, these are missing: {}",
                                      parts.front().shard.count, fmt::join(missing, ", "))});
  }
  if (!faults.empty()) return input_errors(std::move(faults));
  return {};
}

/// Every scenario, mode and set of gains has every sample once, from the part that it belongs to.
Status check_rows(const std::vector<ComparisonRow>& rows, const Part& part,
                  std::map<std::tuple<std::string, std::string, YawMode, int>, int>& seen) {
  const std::string place = (part.directory / "comparison.csv").string();
  for (const ComparisonRow& row : rows) {
    if (!part.shard.has(row.sample) || row.sample > part.samples) {
      return input_error(place, fmt::format("sample {} is none of part {} of {}", row.sample,
                                            part.shard.index, part.shard.count));
    }
    if (seen[{row.scenario, row.gains, row.mode, row.sample}]++ > 0) {
      return input_error(place, fmt::format("sample {} of scenario '{}' stands there twice",
                                            row.sample, row.scenario));
    }
  }
  return {};
}

/// The rows of all parts, each row once.
Result<std::vector<ComparisonRow>> rows_of(const std::vector<Part>& parts) {
  std::vector<ComparisonRow> rows;
  std::map<std::tuple<std::string, std::string, YawMode, int>, int> seen;
  for (const Part& part : parts) {
    AWMR_ASSIGN_OR_RETURN(std::vector<ComparisonRow> more,
                          read_rows(part.directory / "comparison.csv", part.csv_sha256));
    AWMR_RETURN_IF_ERROR(check_rows(more, part, seen));
    rows.insert(rows.end(), std::make_move_iterator(more.begin()),
                std::make_move_iterator(more.end()));
  }
  return rows;
}

/// In the order of a single run: scenarios and gains as each part has them, modes, samples. Errors
/// (input): not every one of them has `samples`, counted from 0.
Status put_in_order(std::vector<ComparisonRow>& rows, std::size_t samples) {
  std::map<std::string, std::size_t> scenarios;
  std::map<std::string, std::size_t> gains;
  std::set<YawMode> modes;
  for (const ComparisonRow& row : rows) {
    scenarios.emplace(row.scenario, scenarios.size());
    gains.emplace(row.gains, gains.size());
    modes.insert(row.mode);
  }
  const std::size_t runs = scenarios.size() * gains.size() * modes.size() * samples;
  if (rows.size() != runs) {
    return input_error("", fmt::format("the parts have {} runs, the comparison {}: one of them has "
                                       "lost rows; run it again",
                                       rows.size(), runs));
  }
  const auto key = [&](const ComparisonRow& row) {
    return std::tuple(scenarios[row.scenario], gains[row.gains], row.mode, row.sample);
  };
  std::sort(rows.begin(), rows.end(),
            [&](const ComparisonRow& a, const ComparisonRow& b) { return key(a) < key(b); });
  return {};
}

}  // namespace

std::string shard_text(const Comparison& part, const CompareOptions& options,
                       const Provenance& provenance) {
  Json json = output_document(kShardSchema, provenance);
  json["samples"] = options.samples;
  json["seed"] = options.seed;
  json["relevance"] = options.preferences.relevance;
  json["weights"] = options.preferences.weights;
  json["shard_index"] = options.shard.index;
  json["shard_count"] = options.shard.count;
  json["stopped"] = part.stopped;
  json["arithmetic"] = part.arithmetic;
  json["csv_sha256"] = sha256_hex(comparison_csv(part));
  return to_text(json);
}

std::string shard_schema() {
  return json_schema_text(kShardSchema, "A part of a comparison",
                          [](JsonObject& json) { part_from_json(json); });
}

Result<Merged> merge_shards(const std::vector<std::filesystem::path>& directories) {
  if (directories.empty()) return input_error("", "no directories: give those of all parts");
  std::vector<Part> parts;
  for (const std::filesystem::path& directory : directories) {
    AWMR_ASSIGN_OR_RETURN(Part part, read_part(directory));
    parts.push_back(std::move(part));
  }
  AWMR_RETURN_IF_ERROR(check_parts(parts));
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.shard.index < b.shard.index; });

  const Part& first = parts.front();
  Merged merged;
  AWMR_ASSIGN_OR_RETURN(merged.comparison.rows, rows_of(parts));
  AWMR_RETURN_IF_ERROR(put_in_order(merged.comparison.rows, at(first.samples) + 1));
  merged.comparison.whole_samples = first.samples + 1;
  merged.comparison.arithmetic = first.arithmetic;
  merged.options.samples = first.samples;
  merged.options.seed = first.seed;
  merged.options.preferences = first.preferences;
  merged.provenance = first.provenance;
  return merged;
}

}  // namespace awmr
