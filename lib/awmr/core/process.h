/// Runs other programs with a list of arguments, without a shell.
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
  std::vector<std::string> arguments;    ///< without the program name
  std::filesystem::path directory;       ///< working directory
  std::vector<std::string> environment;  ///< "NAME=value", complete
  double time_limit_s = 60.0;            ///< > 0; then the program is killed
};

struct ProgramEnd {
  int exit_code = -1;      ///< -1: ended by a signal or the time limit
  bool timed_out = false;  ///< the time limit was reached
  std::string output;      ///< stdout and stderr, interleaved, the first 64 KiB
};

/// The executable file of this name in an absolute directory of PATH. Other entries (".", an empty
/// entry) are skipped, because they depend on the working directory.
std::optional<std::filesystem::path> find_program(std::string_view name);

/// PATH, HOME and LANG of this process, and TMPDIR as given: sufficient for a compiler, without
/// variables that change its behaviour (CPATH, GCC_EXEC_PREFIX and the like).
std::vector<std::string> plain_environment(const std::filesystem::path& temporary);

/// Runs a program to its end, with empty stdin and no other open file of this process. Its
/// remaining children are killed. Errors (input): it cannot be started, with the reason.
Result<ProgramEnd> run_program(const ProgramCall& call);

/// Kills all programs that run_program() waits for, with their children; no further one can start.
/// For a process that was requested to terminate.
void end_running_programs();

}  // namespace awmr
