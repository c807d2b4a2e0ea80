/// Adapts messages of other commands for users of `run` and `check`. These messages name
/// command-line options, which `run` and `check` do not have. for_project() replaces each such
/// option by the key of project.json or tune.json with the same effect.
#pragma once

#include <string_view>

#include "commands.h"

namespace awmr::cli {

/// Replaces the options that findings and errors of `command` name (by option_text()). For example,
/// "--as-is" of identify becomes "`identify/as_is` of project.json", and "--family auto" becomes
/// "`"identify": {"family": ["auto"]}` in project.json". An option without such a key gets the name
/// of its command: "awmr compare --break-even".
Result<Outcome> for_project(std::string_view command, Result<Outcome> step);

}  // namespace awmr::cli
