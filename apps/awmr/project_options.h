/// Replaces the command-line options that messages name by the keys of project.json and tune.json
/// with the same effect. Commands that read a project (`run`, `check`) do not have these options.
#pragma once

#include <string_view>

#include "commands.h"

namespace awmr::cli {

/// Replaces each option in the findings or errors of `command` (option_text()) by its key:
/// "--as-is" of identify by "`identify/as_is` of project.json". An option without a key is named
/// with its command: "awmr compare --break-even".
Result<Outcome> for_project(std::string_view command, Result<Outcome> step);

}  // namespace awmr::cli
