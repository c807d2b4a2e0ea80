/// Runs another program, such as a compiler, with a list of arguments and without a shell.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

/// A program to run.
struct ProgramCall {
  std::filesystem::path program;         ///< absolute path, as find_program() returns it
  std::vector<std::string> arguments;    ///< command-line arguments, without the program name
  std::filesystem::path directory;       ///< working directory
  std::vector<std::string> environment;  ///< all of its variables, as "NAME=value"
  double time_limit_s = 60.0;            ///< > 0: the program is killed after this time
};

/// How a program ended.
struct ProgramEnd {
  int exit_code = -1;      ///< -1: ended by a signal or by the time limit
  bool timed_out = false;  ///< the time limit was reached
  std::string output;      ///< first 64 KiB of its stdout and stderr together
};

/// The first executable file of this name in the directories of PATH, if any. Relative directories
/// (".") are skipped.
std::optional<std::filesystem::path> find_program(std::string_view name);

/// Environment for a compiler: PATH, HOME and LANG of this process, and `temporary` as TMPDIR.
/// Variables that change the compiler's behaviour, such as CPATH, are left out.
std::vector<std::string> plain_environment(const std::filesystem::path& temporary);

/// Runs a program until it ends or reaches its time limit, then kills the processes that it left
/// running. Its stdin is empty, and it inherits no open files of this process. Errors (input): the
/// program cannot be started.
Result<ProgramEnd> run_program(const ProgramCall& call);

/// Kills all programs that run_program() waits for, and their children. Later calls of
/// run_program() fail. Call it before this process ends, so that no program is left running.
void end_running_programs();

}  // namespace awmr
