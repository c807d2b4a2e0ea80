/// Error messages for an invalid command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace awmr::cli {

/// True if the first word of the command line is neither an option nor a command of `app`.
bool has_unknown_command(const CLI::App& app, int argc, char** argv);

/// Describes an error of the command line: CLI11's message, the unknown command or option, and the
/// known name that is closest to it. Precondition: `app` is unchanged since the parse that failed.
std::string usage_error_text(const CLI::App& app, const CLI::ParseError& error, int argc,
                             char** argv);

}  // namespace awmr::cli
