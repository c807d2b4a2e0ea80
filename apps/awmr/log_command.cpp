#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/core/input_file.h"
#include "awmr/core/json/json.h"
#include "awmr/trials/awl.h"
#include "commands.h"
#include "inputs.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

struct LogCommand {
  fs::path file;
  fs::path output;
};

std::string summary_of(const AwlLog& log, const LogCommand& command) {
  return fmt::format("{}: {} rows in {} run(s), from {:.6g} s to {:.6g} s\n",
                     command.output.string(), log.rows(), log.runs, log.columns[0].front(),
                     log.columns[0].back()) +
         fmt::format(
             "  {} rows missing, {} bytes damaged\n  SHA-256 of the firmware's parameters {}\n",
             log.lost, log.damaged_bytes, log.parameters_sha256);
}

std::string document_of(const AwlLog& log) {
  Json json;
  json["rows"] = log.rows();
  json["runs"] = log.runs;
  json["rows_missing"] = log.lost;
  json["bytes_damaged"] = log.damaged_bytes;
  json["parameters_sha256"] = log.parameters_sha256;
  return awmr::to_text(json);
}

/// Returns a comment for the first lines of the table, which names the source of the data.
std::string origin_of(const AwlLog& log, const InputFile& input) {
  return fmt::format("# awmr {} log: {} SHA-256 {}, firmware with parameters of SHA-256 {}\n",
                     version(), input.name, input.sha256, log.parameters_sha256);
}

Result<Outcome> execute(const LogCommand& command) {
  AWMR_RETURN_IF_ERROR(check_output(command.output, {{command.file}}));
  AWMR_ASSIGN_OR_RETURN(const std::string bytes, read_input(command.file));
  AWMR_ASSIGN_OR_RETURN(const AwlLog log, read_awl(bytes, command.file.string()));
  AWMR_ASSIGN_OR_RETURN(const auto inputs, input_files({command.file}));
  AWMR_RETURN_IF_ERROR(write_file(command.output, origin_of(log, inputs.front()) + log_csv(log)));
  Outcome outcome{.summary = summary_of(log, command),
                  .findings = log.findings,
                  .document = document_of(log),
                  .written = {command.output}};
  put_findings_into_document(outcome);
  return outcome;
}

}  // namespace

void add_log(CLI::App& app, Session& session) {
  auto command = std::make_shared<LogCommand>();
  CLI::App* sub =
      add_command(app, session, "log", "Convert a log of the emitted sketches to CSV",
                  "awmr log LOG00.AWL -o log.csv", [command] { return execute(*command); });
  add_file(*sub, "FILE", command->file,
           "The on-board log, which `identify --log` and `validate --log` also read directly")
      ->required();
  add_output(*sub, command->output, "CSV to write; lost and damaged rows are reported");
}

}  // namespace awmr::cli
