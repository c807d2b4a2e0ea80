/// Functions that all commands use: to return a result with an exit code, to add the command to the
/// command line, and to print to the terminal.
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
  std::string closing = {};  ///< last line of the output, which names the files written
  /// Short summary that the command `run` prints in place of `summary`.
  std::string brief = {};
  std::vector<Finding> findings = {};  ///< printed on stderr
  /// True: the command ran, but its result is negative (exit code 1).
  bool refused = false;
  std::string document = {};                        ///< content of the output file, for `--json`
  std::vector<std::filesystem::path> written = {};  ///< files written by the command
};

/// Result of the executed command, which main() returns.
struct Session {
  int exit_code = 0;
};

/// Adds a command to the command line, with the options `--quiet`, `--verbose`, `--json` and
/// `--version`. The help of the command ends with the example. `execute` runs the command.
CLI::App* add_command(CLI::App& app, Session& session, const std::string& name,
                      const std::string& description, const std::string& example,
                      std::function<Result<Outcome>()> execute);

/// Adds `-o FILE`, required.
CLI::Option* add_output(CLI::App& command, std::filesystem::path& path, const std::string& meaning);
/// Adds `-o DIR`, required.
CLI::Option* add_output_directory(CLI::App& command, std::filesystem::path& path,
                                  const std::string& meaning);

/// Copies the findings of the outcome into its JSON document. Call this function once: when all
/// findings are known, and before the document is written.
void put_findings_into_document(Outcome& outcome);

/// Adds the findings to the outcome's JSON document. If a path is given, also writes the document
/// to it and names the file in the summary.
Status write_document(const std::optional<std::filesystem::path>& path, Outcome& outcome);

/// Checks by check_output() that each of the files `names` can be written into a directory. The
/// directory may be missing. Creates nothing.
Status check_outputs(const std::filesystem::path& directory, const std::vector<std::string>& names,
                     std::span<const std::filesystem::path> inputs);

/// Returns a table of the parameters: value, standard error, 95 % interval, unit and origin.
std::string parameter_table_text(const Model& model);
/// Returns a table of the parameters in N, N m, kg and kg m^2; empty if m' is unknown.
std::string si_table_text(const Model& model);

}  // namespace awmr::cli
