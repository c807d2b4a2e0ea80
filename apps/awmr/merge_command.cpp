#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/compare/comparison_directory.h"
#include "awmr/compare/shard.h"
#include "awmr/core/file.h"
#include "awmr/identify/planning/recover_shard.h"
#include "awmr/model/findings_json.h"
#include "commands.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

struct MergeCommand {
  std::vector<fs::path> parts;
  fs::path output;
};

/// Checks the output files, so that an error is found before the work begins. Errors (input): an
/// output cannot be written, or is a file of one of the parts.
Status check_outputs_of(const MergeCommand& command, const ShardKind& kind,
                        const std::vector<std::string>& outputs) {
  std::vector<fs::path> inputs;
  for (const fs::path& part : command.parts) {
    for (const std::string& file : part_files(kind)) inputs.push_back(part / file);
  }
  return cli::check_outputs(command.output, outputs, inputs);
}

Result<Outcome> merge_comparison(const MergeCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const Merged merged, merge_shards(command.parts));
  AWMR_RETURN_IF_ERROR(
      check_outputs_of(command, comparison_shards(), {kComparisonTable, kComparisonJson}));
  const std::string document = with_findings(
      comparison_text(merged.comparison, merged.options, merged.provenance), merged.findings);
  AWMR_RETURN_IF_ERROR(write_comparison(command.output, merged.comparison, document));
  std::string table = comparison_table(merged.comparison, merged.options);
  for (const auto& [name, text] : merged.provenance.options) {
    if (name == kPlantName) table += fmt::format("{}: {}\n", name, text);
    if (name == kRateName) table += words_of_rate(text);
  }
  const fs::path json = command.output / kComparisonJson;
  return Outcome{
      .summary = table + fmt::format("wrote {} and {}\n", json.string(), kComparisonTable),
      .brief = table,
      .findings = merged.findings,
      .document = document,
      .written = {json, command.output / kComparisonTable}};
}

Result<Outcome> merge_recovery(const MergeCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const MergedRecovery merged, merge_recover_shards(command.parts));
  AWMR_RETURN_IF_ERROR(check_outputs_of(command, recover_shards(), {"recover.json"}));
  AWMR_ASSIGN_OR_RETURN(const Recovery recovery, recovery_of(merged.whole));
  AWMR_RETURN_IF_ERROR(make_directory(command.output));
  Outcome outcome{.summary = recovery_table(recovery),
                  .findings = recovery.findings,
                  .document = recovery_text(recovery, merged.provenance)};
  AWMR_RETURN_IF_ERROR(write_document(command.output / "recover.json", outcome));
  return outcome;
}

Result<Outcome> execute(const MergeCommand& command) {
  AWMR_ASSIGN_OR_RETURN(const std::string schema, schema_of_part(command.parts.front()));
  return schema == recover_shards().schema ? merge_recovery(command) : merge_comparison(command);
}

}  // namespace

void add_merge(CLI::App& app, Session& session) {
  auto command = std::make_shared<MergeCommand>();
  CLI::App* sub = add_command(
      app, session, "merge", "Combine the parts of compare or recover (--shard I/N)",
      "awmr compare --model model.json --gains gains.json --scenario "
      "configs/paper/scenarios/c3_heading_steps.json --samples 20 --shard 1/2 -o part1\n"
      "  awmr compare --model model.json --gains gains.json --scenario "
      "configs/paper/scenarios/c3_heading_steps.json --samples 20 --shard 2/2 -o part2\n"
      "  awmr merge part1 part2 -o merged",
      [command] { return execute(*command); });
  add_directory(*sub, "DIR", command->parts, "Directories of all parts, in any order")->required();
  add_output_directory(*sub, command->output,
                       "Directory for comparison.csv and comparison.json, or recover.json, with "
                       "the same bytes as a single run");
}

}  // namespace awmr::cli
