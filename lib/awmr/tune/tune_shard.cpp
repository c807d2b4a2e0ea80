#include "awmr/tune/tune_shard.h"

#include <fmt/format.h>

#include <utility>

#include "awmr/core/csv.h"
#include "awmr/core/csv_cell.h"
#include "awmr/core/index.h"
#include "awmr/core/shard_file.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/gains_file.h"
#include "awmr/simulate/batch.h"
#include "awmr/tune/option_table.h"
#include "awmr/tune/robust.h"
#include "awmr/tune/tune_findings.h"
#include "awmr/tune/tune_json.h"

namespace awmr {
namespace {

/// Maximum of evaluation_draws, as in tune.json.
constexpr long kMaxEvaluationDraws = 100'000;

/// Content of the keys of shard.json that only a tuning has. The runs are in judged.csv.
struct Payload {
  int evaluation_draws = 0;
  std::vector<std::string> gains;
  EvaluationSetup by;
  std::vector<Finding> findings;
};

Payload read_payload(JsonObject& json) {
  Payload payload{
      .evaluation_draws = static_cast<int>(json.integer("judged_draws", 1, kMaxEvaluationDraws)),
      .gains = json.strings("gains"),
      .by = {},
      .findings = {}};
  for (const std::string& name : json.strings("modes")) {
    const auto mode = value_in(kYawModeNames, name);
    if (!mode)
      json.fault(ErrorCode::kUnknownName, "modes", fmt::format("'{}' is not a mode", name));
    payload.by.modes.push_back(mode.value_or(YawMode::kCombined));
  }
  if (payload.by.modes.empty()) json.fault(ErrorCode::kMissing, "modes", "contains no mode");
  if (payload.gains.empty())
    json.fault(ErrorCode::kMissing, "gains", "contains no evaluated gains");
  payload.by.scenarios = json.strings("scenarios");
  if (payload.by.scenarios.empty()) {
    json.fault(ErrorCode::kMissing, "scenarios", "contains no scenario");
  }
  payload.by.tail_share = json.number("tail_share", kShareAboveZero);
  for (JsonObject& goal : json.objects("goals")) {
    payload.by.goals.push_back(read_goal(std::move(goal)));
  }
  payload.findings = read_findings(json);
  return payload;
}

std::string head_of_table() {
  std::string head = "gains,draw,mode,scenario,completed,broke_off";
  for (const std::string& name : run_figure_names()) head += "," + name;
  return head;
}

/// The cells of a row that identify its run, with a comma at the end.
std::string place_of_row(const std::string& gains, int draw, YawMode mode, std::size_t scenario) {
  return fmt::format("{},{},{},{},", gains, draw, name_of(mode), scenario + 1);
}

/// Reads the outcome of a run from a line of judged.csv. Empty if the line is no valid row that
/// begins with `place`.
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

/// Removes the first line from the text and returns it without its end.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// Reads the runs of a part from `text`, a judged.csv: by gains, draw, mode, scenario. Errors
/// (input), with the line: a run of another part, a run in the wrong order, or a missing run.
Result<std::vector<RunOutcome>> evaluated_runs_from_text(const Payload& payload, const Shard& shard,
                                                         std::string_view text,
                                                         const std::string& file) {
  std::string_view rest = text;
  if (take_line(rest) != head_of_table()) {
    return input_error(ErrorCode::kStaleResult, file + ":1:1",
                       "these are not the columns of judged.csv; run the part again");
  }
  int line = 1;
  std::vector<RunOutcome> runs;
  for (const std::string& gains : payload.gains) {
    for (int i = 0; i < shard.share_of(payload.evaluation_draws); ++i) {
      for (const YawMode mode : payload.by.modes) {
        for (std::size_t scenario = 0; scenario < payload.by.scenarios.size(); ++scenario) {
          ++line;
          const std::string place = place_of_row(gains, shard.item(i) + 1, mode, scenario);
          const auto outcome = outcome_in(take_line(rest), place, mode);
          if (!outcome) {
            return input_error(
                ErrorCode::kStaleResult, fmt::format("{}:{}:1", file, line),
                fmt::format(
                    "expected the run {} (gains, draw, mode, scenario) in this row; run the part "
                    "again",
                    std::string_view(place).substr(0, place.size() - 1)));
          }
          runs.push_back(*outcome);
        }
      }
    }
  }
  if (!rest.empty()) {
    return input_error(ErrorCode::kStaleResult, fmt::format("{}:{}:1", file, line + 1),
                       "this row is not a run of this part; run the part again");
  }
  return runs;
}

Status check_judged(std::string_view text, const std::string& file, const std::string& shard_json) {
  const Json json = Json::parse(shard_json);
  AWMR_RETURN_IF_ERROR(evaluated_runs_from_text(
      payload_of(json, read_payload), {json["shard_index"], json["shard_count"]}, text, file));
  return {};
}

/// Reads the runs of all parts and orders them by gains, then draw.
Result<std::vector<EvaluatedRuns>> read_all_runs(const std::vector<Part>& parts,
                                                 const Payload& payload) {
  const ShardFile& table = tune_shards().files.front();
  std::vector<std::vector<RunOutcome>> runs;
  for (const Part& part : parts) {
    AWMR_ASSIGN_OR_RETURN(const std::string text, read_part_file(part, table));
    AWMR_ASSIGN_OR_RETURN(std::vector<RunOutcome> of_part,
                          evaluated_runs_from_text(payload, part.origin.shard, text,
                                                   (part.directory / table.name).string()));
    runs.push_back(std::move(of_part));
  }
  AWMR_ASSIGN_OR_RETURN(const std::vector<RunOutcome> all,
                        in_order_of_items(runs, payload.evaluation_draws,
                                          payload.by.modes.size() * payload.by.scenarios.size()));
  std::vector<EvaluatedRuns> by_gains;
  const auto of_each = eigen_index(all.size() / payload.gains.size());
  for (auto begin = all.begin(); begin != all.end(); begin += of_each) {
    by_gains.push_back({payload.gains[by_gains.size()], {begin, begin + of_each}});
  }
  return by_gains;
}

/// Reads gains.json, which is identical in all parts.
Result<Json> read_gains_json(const std::vector<Part>& parts) {
  const ShardFile& file = tune_shards().files.back();
  for (const Part& part : parts) AWMR_RETURN_IF_ERROR(read_part_file(part, file));
  const std::filesystem::path path = parts.front().directory / file.name;
  AWMR_ASSIGN_OR_RETURN(Json json, read_json_file(path));
  if (!json.is_object() || !json.contains("robust") || !json["robust"].is_object()) {
    return input_error(
        ErrorCode::kStaleResult, path.string(),
        "has no `robust` object, so its gains were tuned with nominal, which cannot be divided "
        "into parts; run the part again without nominal");
  }
  return json;
}

/// The text of judged.csv: the columns gains, draw, mode, scenario (its number, from 1), completed,
/// broke_off, then the metrics of run_figure_names().
std::string evaluation_csv(const Tuning& tuning, const TuneOptions& options) {
  const std::vector<EvaluatedRuns>& all = tuning.robust->runs;
  const std::size_t draws = at(options.shard->share_of(options.evaluation_draws));
  std::string text = head_of_table() + "\n";
  for (const EvaluatedRuns& runs : all) {
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

}  // namespace

const ShardKind& tune_shards() {
  static const ShardKind kind{
      .schema = "awmr.tune_shard/1",
      .title = "A part of the evaluation of gains on fresh draws",
      .files = {{"judged.csv", "csv_sha256", check_judged},
                {"gains.json", "gains_json_sha256",
                 [](std::string_view text, const std::string& file, const std::string&) {
                   return check_gains_text(text, file);
                 }}},
      .own_keys = {"findings"},
      .arithmetic = batch_rounding,
      .arithmetic_advice = "run all parts on processors with AVX2 or NEON",
      .read = [](JsonObject& json) { read_payload(json); }};
  return kind;
}

PartText tune_part(const Tuning& tuning, const TuneOptions& options, const Provenance& provenance,
                   const std::vector<Finding>& findings) {
  Json json{{"judged_draws", options.evaluation_draws},
            {"gains", Json::array()},
            {"modes", Json::array()},
            {"scenarios", Json::array()},
            {"tail_share", options.tail_share},
            {"goals", Json::array()}};
  for (const EvaluatedRuns& runs : tuning.robust->runs) json["gains"].push_back(runs.gains);
  // Lists each mode once: the scores are sorted by mode, then scenario.
  for (const ModeScore& score : tuning.scores) {
    if (score.scenario == tuning.scores.front().scenario) {
      json["modes"].push_back(name_of(score.mode));
    }
    if (score.mode == tuning.scores.front().mode) json["scenarios"].push_back(score.scenario);
  }
  for (const TuningGoal& goal : options.goals) json["goals"].push_back(goal_json(goal));
  PartText text = part_text(
      tune_shards(),
      {.provenance = provenance, .shard = *options.shard, .arithmetic = tuning.arithmetic},
      {evaluation_csv(tuning, options), gains_text(tuning, options, provenance)}, json);
  text.shard_json = with_findings(text.shard_json, findings);
  return text;
}

Result<MergedTuning> merge_tune_shards(const std::vector<std::filesystem::path>& directories) {
  AWMR_ASSIGN_OR_RETURN(const std::vector<Part> parts, read_parts(tune_shards(), directories));
  const Payload payload = payload_of(parts.front().json, read_payload);
  AWMR_ASSIGN_OR_RETURN(const std::vector<EvaluatedRuns> runs, read_all_runs(parts, payload));
  AWMR_ASSIGN_OR_RETURN(Json json, read_gains_json(parts));
  EvaluationResult evaluation = evaluation_of(runs, payload.by);
  json["robust"]["quantiles"] = quantiles_json(evaluation.gains);
  if (!evaluation.by_scenario.empty()) {
    json["robust"]["by_scenario"] = by_scenario_json(evaluation.by_scenario);
  }
  if (!evaluation.goals.empty()) json["goals"] = goals_json(evaluation.goals);
  std::vector<Finding> findings =
      evaluation_findings(evaluation.gains, evaluation.by_scenario, evaluation.goals);
  findings.insert(findings.end(), payload.findings.begin(), payload.findings.end());
  return MergedTuning{to_text(json), std::move(evaluation.gains), std::move(evaluation.by_scenario),
                      std::move(evaluation.goals), std::move(findings)};
}

}  // namespace awmr
