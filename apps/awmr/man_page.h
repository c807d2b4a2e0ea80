/// Manual pages, in the language of man(7).
#pragma once

#include <string>
#include <vector>

#include "command_info.h"

namespace awmr::cli {

/// "awmr" of the program itself, "awmr-identify" of a command: the page's name, without section.
std::string page_name(const CommandInfo& command);

/// The page of a command; of the program itself one that lists the commands.
std::string man_page(const CommandInfo& command, const std::vector<CommandInfo>& commands);

}  // namespace awmr::cli
