#include "awmr/tune/tune_shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/csv_cell.h"
#include "awmr/core/file.h"
#include "awmr/core/hash.h"
#include "awmr/core/index.h"
#include "awmr/core/json_document.h"
#include "awmr/core/shard_file.h"
#include "awmr/model/findings_json.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/tune_findings.h"
#include "awmr/tune/tune_json.h"

namespace awmr {
namespace {

constexpr const char* kGainsHash = "gains_json_sha256";
/// Limits of an evaluation: as in tune.json, and more than are ever given.
constexpr long kMostJudgedDraws = 100'000;

/// One directory's part; its runs lie in the table.
struct TunePart {
  ShardOrigin origin;
  int judged_draws = 0;
  std::vector<std::string> gains;
  JudgedBy by;
  std::string gains_sha256;
  std::vector<Finding> findings;

  /// The draws of this part.
  int draws() const { return origin.shard.share_of(judged_draws); }
};

TunePart tune_part_from_json(JsonObject& json) {
  TunePart part{.origin = read_shard_origin(json, kTuneShardSchema),
                .judged_draws = static_cast<int>(json.integer("judged_draws", 1, kMostJudgedDraws)),
                .gains = json.strings("gains"),
                .by = {},
                .gains_sha256 = json.string(kGainsHash),
                .findings = {}};
  for (const std::string& name : json.strings("modes")) {
    const auto mode = value_in(kYawModeNames, name);
    if (!mode) json.fault("modes", fmt::format("'{}' is no mode", name));
    part.by.modes.push_back(mode.value_or(YawMode::kCombined));
  }
  if (part.by.modes.empty()) json.fault("modes", "names no mode");
  if (part.gains.empty()) json.fault("gains", "names no evaluated gains");
  part.by.scenarios = json.strings("scenarios");
  if (part.by.scenarios.empty()) json.fault("scenarios", "names no scenario");
  part.by.tail_share = json.number("tail_share", {.min = 0.0, .max = 1.0, .min_excluded = true});
  for (JsonObject& goal : json.objects("goals")) {
    part.by.goals.push_back(read_goal(std::move(goal)));
  }
  part.findings = read_findings(json);
  json.reject_unknown_keys();
  return part;
}

/// Why a part is not of the same search as the first; empty where it is.
std::string other_search(const TunePart& first, const TunePart& part) {
  std::string other =
      other_arithmetic(first.origin, part.origin, "run all parts on processors with AVX2 or NEON");
  if (!other.empty()) return other;
  const JudgedBy& a = part.by;
  const JudgedBy& b = first.by;
  const auto goals_of = [](const JudgedBy& by) {
    Json goals = Json::array();
    for (const TuningGoal& goal : by.goals) goals.push_back(goal_json(goal));
    return goals;
  };
  if (part.judged_draws != first.judged_draws || part.gains != first.gains ||
      part.gains_sha256 != first.gains_sha256 || a.modes != b.modes || a.scenarios != b.scenarios ||
      a.tail_share != b.tail_share || goals_of(a) != goals_of(b)) {
    return made_with_other_options(first.origin);
  }
  return {};
}

std::string head_of_table() {
  std::string head = "gains,draw,mode,scenario,completed,broke_off";
  for (const std::string& name : run_figure_names()) head += "," + name;
  return head;
}

/// The cells of a row that say which run it is, with a comma behind.
std::string place_of_row(const std::string& gains, int draw, YawMode mode, std::size_t scenario) {
  return fmt::format("{},{},{},{},", gains, draw, name_of(mode), scenario + 1);
}

/// None where the cells are no row that begins with `place`.
std::optional<RunOutcome> outcome_in(std::string_view line, std::string_view place, YawMode mode) {
  if (!line.starts_with(place)) return std::nullopt;
  std::string_view rest = line.substr(place.size());
  const std::vector<std::string> cells = take_text_record(rest);
  if (cells.size() != 2 + kRunFigures) return std::nullopt;
  for (const std::string& flag : {cells[0], cells[1]}) {
    if (flag != "0" && flag != "1") return std::nullopt;
  }
  RunOutcome outcome{.mode = mode, .completed = cells[0] == "1", .broke_off = cells[1] == "1"};
  for (std::size_t i = 0; i < kRunFigures; ++i) {
    const auto number = number_from_text(cells[2 + i]);
    if (!number) return std::nullopt;
    outcome.figures[i] = *number;
  }
  return outcome;
}

/// Takes the first line off the text, without its end.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// The runs of a part, by gains: of each those of its draws in their order. Errors (input), by
/// line: a run that is none of the part's, in another place, or missing.
Result<std::vector<JudgedRuns>> judged_from_text(const TunePart& part, std::string_view text,
                                                 const std::string& file) {
  std::string_view rest = text;
  if (take_line(rest) != head_of_table()) {
    return input_error(file + ":1:1", "these are not the columns of judged.csv");
  }
  int line = 1;
  std::vector<JudgedRuns> runs;
  for (const std::string& gains : part.gains) {
    runs.push_back({gains, {}});
    for (int i = 0; i < part.draws(); ++i) {
      for (const YawMode mode : part.by.modes) {
        for (std::size_t scenario = 0; scenario < part.by.scenarios.size(); ++scenario) {
          ++line;
          const std::string place =
              place_of_row(gains, part.origin.shard.item(i) + 1, mode, scenario);
          const auto outcome = outcome_in(take_line(rest), place, mode);
          if (!outcome) {
            return input_error(fmt::format("{}:{}:1", file, line),
                               fmt::format("is not the run {} of the part; run the part again",
                                           std::string_view(place).substr(0, place.size() - 1)));
          }
          runs.back().outcomes.push_back(*outcome);
        }
      }
    }
  }
  if (!rest.empty()) {
    return input_error(fmt::format("{}:{}:1", file, line + 1), "is none of the part's runs");
  }
  return runs;
}

Result<std::vector<JudgedRuns>> read_judged(const TunePart& part) {
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_shard_table(part.origin, kJudgedTable));
  return judged_from_text(part, text, (part.origin.directory / kJudgedTable).string());
}

/// The runs of all parts, by gains, then draw. `parts` are in the order of their numbers.
Result<std::vector<JudgedRuns>> read_all_runs(const std::vector<TunePart>& parts) {
  const TunePart& first = parts.front();
  std::vector<std::vector<JudgedRuns>> by_part;
  for (const TunePart& part : parts) {
    AWMR_ASSIGN_OR_RETURN(std::vector<JudgedRuns> runs, read_judged(part));
    by_part.push_back(std::move(runs));
  }
  const std::size_t per_draw = first.by.modes.size() * first.by.scenarios.size();
  std::vector<JudgedRuns> all;
  for (std::size_t g = 0; g < first.gains.size(); ++g) {
    JudgedRuns whole{first.gains[g], {}};
    for (std::size_t draw = 0; draw < at(first.judged_draws); ++draw) {
      const std::vector<RunOutcome>& outcomes = by_part[draw % parts.size()][g].outcomes;
      const auto begin = outcomes.begin() + eigen_index(draw / parts.size() * per_draw);
      whole.outcomes.insert(whole.outcomes.end(), begin, begin + eigen_index(per_draw));
    }
    all.push_back(std::move(whole));
  }
  return all;
}

/// The gains of a part, as they were written with it.
Result<Json> read_part_gains(const TunePart& part) {
  const std::filesystem::path path = part.origin.directory / kTuneShardGains;
  AWMR_RETURN_IF_ERROR(check_regular_file(path));
  AWMR_ASSIGN_OR_RETURN(const std::string text, read_file(path));
  if (sha256_hex(text) != part.gains_sha256) {
    return input_error(path.string(),
                       "is not the file that shard.json was written with: run the "
                       "part again");
  }
  return read_json_file(path);
}

}  // namespace

std::string judged_csv(const Tuning& tuning, const TuneOptions& options) {
  const std::vector<JudgedRuns>& all = tuning.robust->runs;
  const std::size_t draws = at(options.shard->share_of(options.judged_draws));
  std::string text = head_of_table() + "\n";
  for (const JudgedRuns& runs : all) {
    const std::size_t per_draw = runs.outcomes.size() / draws;
    std::size_t scenario = 0;
    for (std::size_t i = 0; i < runs.outcomes.size(); ++i) {
      const RunOutcome& outcome = runs.outcomes[i];
      const bool starts_mode = i % per_draw == 0 || runs.outcomes[i - 1].mode != outcome.mode;
      scenario = starts_mode ? 0 : scenario + 1;
      const int draw = options.shard->item(static_cast<int>(i / per_draw)) + 1;
      text += place_of_row(runs.gains, draw, outcome.mode, scenario);
      text += fmt::format("{},{}", outcome.completed ? 1 : 0, outcome.broke_off ? 1 : 0);
      for (const double figure : outcome.figures) text += "," + format_number(figure);
      text += '\n';
    }
  }
  return text;
}

std::string tune_shard_text(const Tuning& tuning, const TuneOptions& options,
                            const Provenance& provenance) {
  Json json =
      shard_document(kTuneShardSchema, {.provenance = provenance,
                                        .shard = *options.shard,
                                        .arithmetic = tuning.arithmetic,
                                        .csv_sha256 = sha256_hex(judged_csv(tuning, options))});
  json[kGainsHash] = sha256_hex(gains_text(tuning, options, provenance));
  json["judged_draws"] = options.judged_draws;
  json["gains"] = Json::array();
  for (const JudgedRuns& runs : tuning.robust->runs) json["gains"].push_back(runs.gains);
  json["modes"] = Json::array();
  json["scenarios"] = Json::array();
  // The scores are by mode, then scenario.
  for (const ModeScore& score : tuning.scores) {
    if (score.scenario == tuning.scores.front().scenario) {
      json["modes"].push_back(name_of(score.mode));
    }
    if (score.mode == tuning.scores.front().mode) json["scenarios"].push_back(score.scenario);
  }
  json["tail_share"] = options.tail_share;
  json["goals"] = Json::array();
  for (const TuningGoal& goal : options.goals) json["goals"].push_back(goal_json(goal));
  return to_text(json);
}

bool is_finished_tune_shard(const std::filesystem::path& directory, const Shard& shard,
                            const Provenance& provenance) {
  const auto arithmetic = batch_arithmetic();
  if (!check_regular_file(directory / kShardFile) ||
      !check_regular_file(directory / kTuneShardGains)) {
    return false;
  }
  const auto json = read_json_file(directory / kShardFile);
  const auto gains = read_file(directory / kTuneShardGains);
  if (!arithmetic || !json || !gains || !json->is_object()) return false;
  const auto hash = json->find(kGainsHash);
  if (hash == json->end() || *hash != sha256_hex(*gains)) return false;
  return is_finished_part(
      directory, kTuneShardSchema,
      {.provenance = provenance, .shard = shard, .arithmetic = std::string(arithmetic->rounding)},
      kJudgedTable);
}

Result<MergedTuning> merge_tune_shards(const std::vector<std::filesystem::path>& directories) {
  AWMR_ASSIGN_OR_RETURN(
      const std::vector<TunePart> parts,
      read_parts(directories, kTuneShardSchema, tune_part_from_json, other_search));
  AWMR_ASSIGN_OR_RETURN(const std::vector<JudgedRuns> runs, read_all_runs(parts));
  for (const TunePart& part : parts) {
    AWMR_RETURN_IF_ERROR(read_part_gains(part));
  }
  AWMR_ASSIGN_OR_RETURN(Json json, read_part_gains(parts.front()));
  if (!json.is_object() || !json.contains("robust") || !json["robust"].is_object()) {
    return input_error((directories.front() / kTuneShardGains).string(),
                       "contains no robust gains; run the part again");
  }
  Judgement judgement = judgement_of(runs, parts.front().by);
  json["robust"]["quantiles"] = quantiles_json(judgement.gains);
  if (!judgement.by_scenario.empty()) {
    json["robust"]["by_scenario"] = by_scenario_json(judgement.by_scenario);
  }
  if (!judgement.goals.empty()) json["goals"] = goals_json(judgement.goals);
  std::vector<Finding> findings =
      evaluation_findings(judgement.gains, judgement.by_scenario, judgement.goals);
  findings.insert(findings.end(), parts.front().findings.begin(), parts.front().findings.end());
  return MergedTuning{to_text(json), std::move(judgement.gains), std::move(judgement.by_scenario),
                      std::move(judgement.goals), std::move(findings)};
}

Status check_judged_csv(std::string_view text, const std::string& file,
                        const std::string& shard_json) {
  TunePart part;
  AWMR_RETURN_IF_ERROR(check_json_object(
      shard_json, file, [&](JsonObject& json) { part = tune_part_from_json(json); }));
  AWMR_RETURN_IF_ERROR(judged_from_text(part, text, file));
  return {};
}

Status check_tune_shard_text(std::string_view text, const std::string& file) {
  return check_json_object(text, file, tune_part_from_json);
}

std::string tune_shard_schema() {
  return json_schema_text(kTuneShardSchema, "A part of the evaluation of gains on fresh draws",
                          [](JsonObject& json) { tune_part_from_json(json); });
}

}  // namespace awmr
