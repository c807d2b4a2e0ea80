/// Functions that all commands use: their outcome, registration on the command line, terminal
/// output.
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

/// Result of a command as presented to the user.
struct Outcome {
  std::string summary = {};  ///< text for stdout: results first, at most one screen
  /// printed below the summary with `--verbose`; the output files contain the same numbers
  std::string details = {};
  std::string closing = {};            ///< last line of the output, which names the files written
  std::string brief = {};              ///< short summary that `run` prints instead
  std::vector<Finding> findings = {};  ///< printed on stderr
  bool refused = false;                ///< true: the command ran, with a negative result (exit code
                                       ///< 1)
  std::string document = {};           ///< content of the output file, for `--json`
  std::vector<std::filesystem::path> written = {};  ///< files written by the command
};

/// Result of the executed command for main().
struct Session {
  int exit_code = 0;
};

/// Adds a subcommand with the options `--quiet`, `--verbose`, `--json` and `--version`, and with an
/// example below its help. `execute` runs the command.
CLI::App* add_command(CLI::App& app, Session& session, const std::string& name,
                      const std::string& description, const std::string& example,
                      std::function<Result<Outcome>()> execute);

/// Adds `-o FILE`, required.
CLI::Option* add_output(CLI::App& command, std::filesystem::path& path, const std::string& meaning);
/// Adds `-o DIR`, required.
CLI::Option* add_output_directory(CLI::App& command, std::filesystem::path& path,
                                  const std::string& meaning);

/// Copies the outcome's findings into its JSON document. Call it once all findings are known and
/// before writing the document.
void put_findings_into_document(Outcome& outcome);

/// Adds the findings to the outcome's JSON document. With a path, also writes the document and adds
/// the file to the summary.
Status write_document(const std::optional<std::filesystem::path>& path, Outcome& outcome);

/// Applies check_output() to each of `names` in a directory that may not exist yet. Creates
/// nothing.
Status check_outputs(const std::filesystem::path& directory, const std::vector<std::string>& names,
                     std::span<const std::filesystem::path> inputs);

/// One line per identified quantity: value, standard error, 95 % interval, unit, origin.
std::string parameter_table_text(const Model& model);
/// One line per identified quantity in N, N m, kg and kg m^2; empty if m' is unknown.
std::string si_table_text(const Model& model);

}  // namespace awmr::cli
