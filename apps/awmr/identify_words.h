/// The options of a fit as words of the command line: those of `identify`, and of `live`, which ends
/// with it.
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "inputs.h"

namespace awmr::cli {

/// The command and what the command line says of it in words.
struct IdentifyWords {
  IdentifyCommand command;
  ColumnWords columns;
  std::vector<std::string> asked;
  std::vector<std::string> families;
  std::string method;
  std::string noise;
  std::string loss = "squares";
  std::string prefer = "printed";
};

/// Errors: a malformed column mapping; an unknown parameter or family.
Result<IdentifyCommand> command_of(const IdentifyWords& words);

/// `--vehicle` and the tables.
void add_table_files(CLI::App& sub, IdentifyCommand& command);
/// What is fitted, and how.
void add_fit_options(CLI::App& sub, IdentifyWords& words);
/// How logs are fitted.
void add_log_options(CLI::App& sub, IdentifyCommand& command);
/// How files are read.
void add_reading_options(CLI::App& sub, IdentifyWords& words);

}  // namespace awmr::cli
