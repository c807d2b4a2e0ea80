/// Manual pages in man(7) format.
#pragma once

#include <string>
#include <vector>

#include "command_info.h"

namespace awmr::cli {

/// Returns the name of the command's manual page, without the section: "awmr" for the program,
/// "awmr-identify" for a command.
std::string page_name(const CommandInfo& command);

/// Returns the manual page of a command. If `command` is the program itself, the page lists all
/// commands.
std::string man_page(const CommandInfo& command, const std::vector<CommandInfo>& commands);

}  // namespace awmr::cli
