#include "awmr/compare/shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "awmr/compare/compare_findings.h"
#include "awmr/compare/resume.h"
#include "awmr/core/hash.h"
#include "awmr/core/index.h"
#include "awmr/core/json_document.h"
#include "awmr/core/shard_file.h"
#include "awmr/model/findings_json.h"
#include "awmr/simulate/batch.h"

namespace awmr {
namespace {

constexpr std::string_view kShardSchema = "awmr.shard/1";
constexpr const char* kTable = "comparison.csv";
/// Maximum number of samples of a comparison.
constexpr long kMostSamples = 1'000'000'000;

/// One directory's part.
struct Part {
  ShardOrigin origin;
  int samples = 0;
  std::uint64_t seed = 0;
  Preferences preferences;
  std::optional<double> measured_yaw_rate_degps;
  std::vector<Change> changes;
  std::vector<Finding> findings;
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

Json change_to_json(const Change& change) {
  Json json{{"scenario", change.scenario},
            {"kind", name_in(kChangeKindNames, change.kind)},
            {"setting", change.setting},
            {"first", Json::array()},
            {"not_run", change.not_run}};
  for (const Contender& one : change.first) {
    json["first"].push_back({{"mode", name_of(one.mode)}, {"gains", one.gains}});
  }
  return json;
}

std::vector<Change> read_changes(JsonObject& json) {
  std::vector<Change> changes;
  for (JsonObject& one : json.optional_objects("changes")) {
    Change change{.scenario = one.string("scenario"),
                  .kind = one.choice("kind", kChangeKindNames),
                  .setting = one.string("setting"),
                  .first = {},
                  .not_run = one.string("not_run")};
    for (JsonObject& first : one.objects("first")) {
      change.first.push_back({first.choice("mode", kYawModeNames), first.string("gains")});
      first.reject_unknown_keys();
    }
    one.reject_unknown_keys();
    changes.push_back(std::move(change));
  }
  return changes;
}

Part part_from_json(JsonObject& json) {
  Part part{.origin = read_shard_origin(json, kShardSchema),
            .samples = static_cast<int>(json.integer("samples", 0, kMostSamples)),
            .seed = json.seed("seed"),
            .preferences = read_preferences(json),
            .measured_yaw_rate_degps = json.optional_number("measured_yaw_rate_degps", kPositive),
            .changes = read_changes(json),
            .findings = read_findings(json)};
  json.reject_unknown_keys();
  return part;
}

/// Why a part is not of the same comparison as the first; empty where it is.
std::string other_comparison(const Part& first, const Part& part) {
  if (part.samples != first.samples || part.seed != first.seed ||
      part.preferences != first.preferences) {
    return made_with_other_options(first.origin);
  }
  return other_arithmetic(first.origin, part.origin,
                          "run all parts on processors with AVX2 or NEON");
}

/// Every scenario, mode and set of gains has every sample once, from the part that it belongs to.
Status check_rows(const std::vector<ComparisonRow>& rows, const Part& part,
                  std::map<std::tuple<std::string, std::string, YawMode, int>, int>& seen) {
  const std::string place = (part.origin.directory / kTable).string();
  const Shard& shard = part.origin.shard;
  for (const ComparisonRow& row : rows) {
    if (!shard.has(row.sample) || row.sample > part.samples) {
      return input_error(place, fmt::format("sample {} is none of part {} of {}", row.sample,
                                            shard.index, shard.count));
    }
    if (seen[{row.scenario, row.gains, row.mode, row.sample}]++ > 0) {
      return input_error(
          place, fmt::format("sample {} of scenario '{}' appears twice", row.sample, row.scenario));
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
                          read_rows(part.origin.directory / kTable, part.origin.csv_sha256));
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
  Json json = shard_document(kShardSchema, {.provenance = provenance,
                                            .shard = options.shard,
                                            .arithmetic = part.arithmetic,
                                            .csv_sha256 = sha256_hex(comparison_csv(part)),
                                            .stopped = part.stopped});
  json["samples"] = options.samples;
  json["seed"] = options.seed;
  json["relevance"] = options.preferences.relevance;
  json["weights"] = options.preferences.weights;
  if (part.measured_yaw_rate_degps) {
    json["measured_yaw_rate_degps"] = *part.measured_yaw_rate_degps;
  }
  for (const Change& change : part.changes) json["changes"].push_back(change_to_json(change));
  return to_text(json);
}

bool is_finished_shard(const std::filesystem::path& directory, const CompareOptions& options,
                       const Provenance& provenance) {
  const auto arithmetic = batch_arithmetic();
  return arithmetic && is_finished_part(directory, kShardSchema,
                                        {.provenance = provenance,
                                         .shard = options.shard,
                                         .arithmetic = std::string(arithmetic->rounding)},
                                        kTable);
}

Status check_shard_text(std::string_view text, const std::string& file) {
  return check_json_object(text, file, part_from_json);
}

std::string shard_schema() {
  return json_schema_text(kShardSchema, "A part of a comparison",
                          [](JsonObject& json) { part_from_json(json); });
}

Result<Merged> merge_shards(const std::vector<std::filesystem::path>& directories) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<Part> parts,
                        read_parts(directories, kShardSchema, part_from_json, other_comparison));
  const Part& first = parts.front();
  Merged merged;
  AWMR_ASSIGN_OR_RETURN(merged.comparison.rows, rows_of(parts));
  AWMR_RETURN_IF_ERROR(put_in_order(merged.comparison.rows, at(first.samples) + 1));
  merged.comparison.whole_samples = first.samples + 1;
  merged.comparison.measured_yaw_rate_degps = first.measured_yaw_rate_degps;
  merged.comparison.changes = first.changes;  // part 1 has them
  merged.comparison.arithmetic = first.origin.arithmetic;
  merged.options.samples = first.samples;
  merged.options.seed = first.seed;
  merged.options.preferences = first.preferences;
  merged.provenance = first.origin.provenance;
  merged.findings = extrapolation_findings(merged.comparison, merged.provenance);
  merged.findings.insert(merged.findings.end(), first.findings.begin(), first.findings.end());
  return merged;
}

}  // namespace awmr
