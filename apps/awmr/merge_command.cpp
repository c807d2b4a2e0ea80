#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "awmr/compare/resume.h"
#include "awmr/compare/shard.h"
#include "awmr/core/file.h"
#include "awmr/core/shard_file.h"
#include "awmr/identify/planning/recover_shard.h"
#include "awmr/model/findings_json.h"
#include "awmr/model/gains_file.h"
#include "awmr/tune/tune_shard.h"
#include "commands.h"
#include "paths.h"
#include "tune_text.h"

namespace awmr::cli {
namespace {

/// Both files of every shard, which the output must not overwrite.
std::vector<fs::path> files_of(const MergeCommand& command, const char* table) {
  std::vector<fs::path> paths;
  for (const fs::path& part : command.parts) {
    paths.push_back(part / kShardFile);
    paths.push_back(part / table);
  }
  return paths;
}

Result<Outcome> merge_comparison(const MergeCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const Merged merged, merge_shards(command.parts));
  AWMR_RETURN_IF_ERROR(check_outputs(command.output, {"comparison.csv", "comparison.json"},
                                     files_of(command, "comparison.csv")));
  const std::string document = with_findings(
      comparison_text(merged.comparison, merged.options, merged.provenance), merged.findings);
  AWMR_RETURN_IF_ERROR(make_directory(command.output));
  const OutputFile files[] = {
      {command.output / "comparison.csv", comparison_csv(merged.comparison), check_comparison_csv},
      {command.output / "comparison.json", document, check_comparison_text}};
  AWMR_RETURN_IF_ERROR(write_files(files));
  std::string table = comparison_table(merged.comparison, merged.options);
  for (const auto& [name, text] : merged.provenance.options) {
    if (name == kPlantName) table += fmt::format("{}: {}\n", name, text);
    if (name == kRateName) table += words_of_rate(text);
  }
  return Outcome{.summary = table + fmt::format("wrote {} and comparison.csv\n",
                                                (command.output / "comparison.json").string()),
                 .brief = table,
                 .findings = merged.findings,
                 .document = document,
                 .written = {files[1].path, files[0].path}};
}

Result<Outcome> merge_recovery(const MergeCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const MergedRecovery merged, merge_recover_shards(command.parts));
  AWMR_RETURN_IF_ERROR(
      check_outputs(command.output, {"recover.json"}, files_of(command, kRecoverTable)));
  AWMR_ASSIGN_OR_RETURN(const Recovery recovery, recovery_of(merged.whole));
  AWMR_RETURN_IF_ERROR(make_directory(command.output));
  Outcome outcome{.summary = recovery_table(recovery),
                  .document = recovery_text(recovery, merged.provenance)};
  AWMR_RETURN_IF_ERROR(write_document(command.output / "recover.json", outcome));
  return outcome;
}

Result<Outcome> merge_tuning(const MergeCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const MergedTuning merged, merge_tune_shards(command.parts));
  std::vector<fs::path> parts = files_of(command, kJudgedTable);
  for (const fs::path& part : command.parts) parts.push_back(part / kTuneShardGains);
  AWMR_RETURN_IF_ERROR(check_outputs(command.output, {"gains.json"}, parts));
  AWMR_RETURN_IF_ERROR(make_directory(command.output));
  Outcome outcome{
      .summary = judged_table(merged.judged, merged.judged_by_scenario) + goals_text(merged.goals),
      .findings = merged.findings,
      .document = merged.gains_text};
  AWMR_RETURN_IF_ERROR(write_document(command.output / "gains.json", outcome, check_gains_text));
  return outcome;
}

}  // namespace

Result<Outcome> execute(const MergeCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const std::string schema, schema_of_part(command.parts.front()));
  if (schema == kRecoverShardSchema) return merge_recovery(command);
  return schema == kTuneShardSchema ? merge_tuning(command) : merge_comparison(command);
}

void add_merge(CLI::App& app, Session& session) {
  auto command = std::make_shared<MergeCommand>();
  CLI::App* sub = add_command(
      app, session, "merge",
      "Put the parts of a compare, a recover or a tune together (--shard I/N)",

      "awmr compare --model model.json --gains gains.json --scenario "
      "configs/paper/scenarios/c3_heading_steps.json --samples 20 --shard 1/2 -o part1\n"
      "  awmr compare --model model.json --gains gains.json --scenario "
      "configs/paper/scenarios/c3_heading_steps.json --samples 20 --shard 2/2 -o part2\n"
      "  awmr merge part1 part2 -o merged",
      [command] { return execute(*command); });
  add_directory(*sub, "DIR", command->parts, "Directories of all parts, in any order")->required();
  add_output_directory(*sub, command->output,
                       "Directory for comparison.csv and comparison.json, or recover.json, or "
                       "gains.json: the bytes of a single run");
}

}  // namespace awmr::cli
