/// Options of a fit, shared by `identify` and `live`; `validate` uses only add_end_options().
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "inputs.h"

namespace awmr::cli {

/// Options of a fit as they come from the command line. CLI11 writes most of them directly into
/// `command`. The members below are those that stay texts, which command_of() parses.
struct IdentifyWords {
  IdentifyCommand command;
  ColumnWords columns;
  std::vector<std::string> requested;
  std::vector<std::string> families;
  std::vector<std::string> excluded;
};

/// Parses the options that are text, and checks that `--until` is after `--from`. Errors: a
/// malformed column mapping or `--exclude` span; a file of columns that cannot be read; `--until`
/// not after `--from`; an unknown parameter; a family that is unknown, given twice, or not possible
/// for its resistance.
Result<IdentifyCommand> command_of(const IdentifyWords& words);

/// Adds `--vehicle`, `--surge`, `--coastdown` and `--turning`.
void add_table_files(CLI::App& sub, IdentifyCommand& command);
/// Adds the options for the estimator and the fitted parameters: `--method` to `--fit`.
void add_fit_options(CLI::App& sub, IdentifyWords& words);
/// Adds the options of log fits: `--steady-from-log` to `--threads`.
void add_log_options(CLI::App& sub, IdentifyCommand& command);
/// Adds `--until` and `--exclude`.
void add_end_options(CLI::App& sub, TrialOptions& trials, std::vector<std::string>& excluded);
/// Adds the options for reading files: `--as-is`, `--prefer`, `--column`, `--columns-file`.
void add_reading_options(CLI::App& sub, IdentifyWords& words);

}  // namespace awmr::cli
