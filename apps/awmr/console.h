/// What every command shares: its outcome, its place on the command line, what it says to a person.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "awmr/core/file.h"
#include "awmr/core/result.h"
#include "awmr/model/model.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace awmr::cli {

/// What a command leaves for the person who ran it.
struct Outcome {
  std::string summary = {};            ///< for stdout: results first, one screen
  std::string details = {};            ///< below it with `--verbose`; the files have them anyway
  std::string closing = {};            ///< the last line: what was written
  std::string brief = {};              ///< the same in a few lines, for `run`
  std::vector<Finding> findings = {};  ///< for stderr
  bool refused = false;                ///< the work ran and the answer is no: exit code 1
  std::string document = {};           ///< for `--json`: what its file holds, or would hold
  std::vector<std::filesystem::path> written = {};  ///< the command's files
};

/// The program's state while one command runs.
struct Session {
  int exit_code = 0;
};

/// Adds a subcommand with `--quiet`, `--verbose`, `--json`, `--version` and an example under its
/// help; `execute` runs it.
CLI::App* add_command(CLI::App& app, Session& session, const std::string& name,
                      const std::string& description, const std::string& example,
                      std::function<Result<Outcome>()> execute);

/// `-o FILE`, required.
CLI::Option* add_output(CLI::App& command, std::filesystem::path& path, const std::string& meaning);
/// `-o DIR`, required.
CLI::Option* add_output_directory(CLI::App& command, std::filesystem::path& path,
                                  const std::string& meaning);

/// Puts the outcome's findings, those that stderr shows, into its document. To be called once all of
/// them are there, before the document is written.
void put_findings_into_document(Outcome& outcome);

/// Puts the findings into the outcome's document, which is JSON, writes it where a path is given, and
/// reports the file in the summary. Without `read_back` it is read back as JSON.
Status write_document(const std::optional<std::filesystem::path>& path, Outcome& outcome,
                      const ReadBack& read_back = {});

/// As check_output for files of a directory, which may not be there yet; nothing is made.
Status check_outputs(const std::filesystem::path& directory, const std::vector<std::string>& names,
                     std::span<const std::filesystem::path> inputs);

/// One line per identified quantity: value, standard error, 95 % interval, unit, origin.
std::string parameter_table_text(const Model& model);
/// The same in newtons, newton metres and kilograms; empty where m' is not known.
std::string si_table_text(const Model& model);

}  // namespace awmr::cli
