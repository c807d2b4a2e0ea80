/// Error messages for an invalid command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace awmr::cli {

/// Describes an error of the command line: CLI11's message, the unknown command or option, and the
/// known name that is closest to it. Precondition: `app` is unchanged since the parse that failed.
std::string usage_error_text(const CLI::App& app, const CLI::ParseError& error, int argc,
                             char** argv);

}  // namespace awmr::cli
