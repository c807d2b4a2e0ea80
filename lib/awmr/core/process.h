/// Other programs, started by their list of arguments: no shell reads what they are given.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

struct ProgramCall {
  std::filesystem::path program;         ///< absolute, see find_program()
  std::vector<std::string> arguments;    ///< without the program's own name
  std::filesystem::path directory;       ///< where it runs
  std::vector<std::string> environment;  ///< "NAME=value", all that it gets
  double time_limit_s = 60.0;            ///< > 0; past it the program is ended by force
};

struct ProgramEnd {
  int exit_code = -1;      ///< -1: ended by a signal, or at the time limit
  bool timed_out = false;  ///< at the time limit
  std::string output;      ///< stdout and stderr as they came, the first 64 KiB
};

/// The executable file of this name in one of the absolute directories of PATH; others (".", an
/// empty entry) depend on where the user stands and are passed over.
std::optional<std::filesystem::path> find_program(std::string_view name);

/// PATH, HOME and LANG as this process has them, and TMPDIR as given: what a compiler needs, and
/// nothing that changes what it does (CPATH, GCC_EXEC_PREFIX and the like).
std::vector<std::string> plain_environment(const std::filesystem::path& temporary);

/// Runs it to its end, with nothing on stdin and no other open file of this process. Whatever it
/// started and left behind ends with it. Errors (input): it cannot be started, with the reason.
Result<ProgramEnd> run_program(const ProgramCall& call);

/// Ends by force what run_program() is waiting for, with all that it started; from then on none
/// starts. For a process that was told to end.
void end_running_programs();

}  // namespace awmr
