#include "awmr/compare/shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "awmr/compare/compare_findings.h"
#include "awmr/compare/comparison_directory.h"
#include "awmr/core/containers.h"
#include "awmr/core/files/shard_file.h"
#include "awmr/core/index.h"
#include "awmr/model/findings_json.h"

namespace awmr {
namespace {

constexpr long kMaxSamples = 1'000'000'000;

/// Keys of shard.json that only a divided comparison has, and no other divided computation.
struct Payload {
  int samples = 0;
  std::uint64_t seed = 0;
  Preferences preferences;
  std::optional<double> measured_yaw_rate_degps;
  std::map<std::string, TurnCommands> turn_commands;
  std::vector<Change> changes;
  std::vector<Finding> findings;
};

Preferences read_preferences(JsonObject& json) {
  Preferences preferences;
  preferences.relevance = json.number("relevance", kRelevance);
  JsonObject weights = json.object("weights");
  for (const std::string& name : weights.keys()) {
    preferences.weights[name] = weights.number(name, {.min = 0.0, .max = kMaximumWeight});
  }
  return preferences;
}

Json turn_commands_to_json(const std::map<std::string, TurnCommands>& all) {
  Json json = Json::object();
  for (const auto& [scenario, commands] : all) {
    Json& one = json[scenario] = {{"are_headings", commands.are_headings}};
    if (commands.rate_max_degps) one["rate_max_degps"] = *commands.rate_max_degps;
  }
  return json;
}

/// Empty for a part of an older version.
std::map<std::string, TurnCommands> read_turn_commands(JsonObject& json) {
  std::map<std::string, TurnCommands> all;
  auto scenarios = json.optional_object("turn_commands");
  if (!scenarios) return all;
  for (const std::string& name : scenarios->keys()) {
    all[name] = scenarios->object(name, [](JsonObject& one) {
      return TurnCommands{.are_headings = one.boolean("are_headings"),
                          .rate_max_degps = one.optional_number("rate_max_degps", kPositive)};
    });
  }
  return all;
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
  for (const Completion& one : change.completed) {
    json["completed"].push_back({{"mode", name_of(one.contender.mode)},
                                 {"gains", one.contender.gains},
                                 {"count", one.count},
                                 {"of", one.of}});
  }
  return json;
}

Contender read_contender(JsonObject& json) {
  return {json.choice("mode", kYawModeNames), json.string("gains")};
}

Completion read_completion(JsonObject& json) {
  return {read_contender(json), at(json.integer("count", 0, kMaxSamples)),
          at(json.integer("of", 1, kMaxSamples))};
}

Change read_change(JsonObject& json) {
  Change change{.scenario = json.string("scenario"),
                .kind = json.choice("kind", kChangeKindNames),
                .setting = json.string("setting"),
                .first = {},
                .not_run = json.string("not_run")};
  change.first = json.objects("first", read_contender);
  change.completed = json.optional_objects("completed", read_completion);
  return change;
}

Payload read_payload(JsonObject& json) {
  return {.samples = static_cast<int>(json.integer("samples", 0, kMaxSamples)),
          .seed = json.seed("seed"),
          .preferences = read_preferences(json),
          .measured_yaw_rate_degps = json.optional_number("measured_yaw_rate_degps", kPositive),
          .turn_commands = read_turn_commands(json),
          .changes = json.optional_objects("changes", read_change),
          .findings = read_findings(json)};
}

/// Returns the rows of all parts in the order of an undivided comparison.
Result<std::vector<ComparisonRow>> rows_of(const std::vector<Part>& parts, int items) {
  const ShardKind& kind = comparison_shards();
  std::vector<std::vector<ComparisonRow>> rows;
  for (const Part& part : parts) {
    AWMR_ASSIGN_OR_RETURN(const std::string text, read_table(kind, part));
    AWMR_ASSIGN_OR_RETURN(std::vector<ComparisonRow> more,
                          comparison_rows(text, (part.directory / kind.table).string()));
    AWMR_RETURN_IF_ERROR(check_items(kind, part, "sample", items, more.size(),
                                     [&](std::size_t i) { return more[i].sample; }));
    rows.push_back(std::move(more));
  }
  return in_order_of_items(rows, items);
}

/// Checks that each scenario, mode and set of gains has `items` consecutive rows. Error (input):
/// rows are missing or appear twice.
Status check_groups(const std::vector<ComparisonRow>& rows, std::size_t items) {
  const auto group_of = [&](std::size_t i) {
    return std::tuple(rows[i].scenario, rows[i].gains, rows[i].mode);
  };
  std::set<std::tuple<std::string, std::string, YawMode>> seen;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t first = i - i % items;
    if (i == first ? seen.insert(group_of(i)).second : group_of(i) == group_of(first)) continue;
    return input_error(ErrorCode::kStaleResult, "",
                       fmt::format("rows of sample {} of scenario '{}' are missing or appear twice "
                                   "in the parts; run the parts again",
                                   rows[i].sample, rows[i].scenario));
  }
  return {};
}

}  // namespace

const ShardKind& comparison_shards() {
  static const ShardKind kind{
      .schema = "awmr.shard/1",
      .title = "A part of a comparison",
      .table = kComparisonTable,
      .check = [](std::string_view text, const std::string& file,
                  const std::string&) { return check_comparison_csv(text, file); },
      // Keys whose values may differ between parts. `changes` is only in part 1.
      .own_keys = {"changes", "findings"},
      .arithmetic_advice = "run all parts on processors with AVX2 or NEON",
      .read = [](JsonObject& json) { read_payload(json); }};
  return kind;
}

PartText comparison_part(const Comparison& part, const CompareOptions& options,
                         const Provenance& provenance, const std::vector<Finding>& findings) {
  Json json{{"samples", options.samples},
            {"seed", options.seed},
            {"relevance", options.preferences.relevance},
            {"weights", options.preferences.weights}};
  if (part.measured_yaw_rate_degps) {
    json["measured_yaw_rate_degps"] = *part.measured_yaw_rate_degps;
  }
  json["turn_commands"] = turn_commands_to_json(part.turn_commands);
  for (const Change& change : part.changes) json["changes"].push_back(change_to_json(change));
  PartText text =
      part_text(comparison_shards(),
                {.provenance = provenance, .shard = options.shard, .arithmetic = part.arithmetic},
                comparison_csv(part), json);
  text.shard_json = with_findings(text.shard_json, findings);
  return text;
}

Result<Merged> merge_shards(const std::vector<std::filesystem::path>& directories) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<Part> parts,
                        read_parts(comparison_shards(), directories));
  const PartOrigin& origin = parts.front().origin;
  const Payload payload = payload_of(parts.front().json, read_payload);
  Merged merged;
  merged.provenance = origin.provenance;
  merged.options.samples = payload.samples;
  merged.options.seed = payload.seed;
  merged.options.preferences = payload.preferences;
  merged.comparison.whole_samples = payload.samples + 1;
  merged.comparison.arithmetic = origin.arithmetic;
  merged.comparison.measured_yaw_rate_degps = payload.measured_yaw_rate_degps;
  merged.comparison.turn_commands = payload.turn_commands;
  merged.comparison.changes = payload.changes;
  AWMR_ASSIGN_OR_RETURN(merged.comparison.rows, rows_of(parts, payload.samples + 1));
  AWMR_RETURN_IF_ERROR(check_groups(merged.comparison.rows, at(payload.samples) + 1));
  merged.findings = completion_findings(merged.comparison);
  std::ranges::move(extrapolation_findings(merged.comparison, merged.provenance),
                    std::back_inserter(merged.findings));
  append(merged.findings, payload.findings);
  return merged;
}

}  // namespace awmr
