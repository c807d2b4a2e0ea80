/// Manual pages in man(7) format.
#pragma once

#include <string>
#include <vector>

#include "command_info.h"

namespace awmr::cli {

/// Page name without section: "awmr" for the program, "awmr-identify" for a command.
std::string page_name(const CommandInfo& command);

/// Returns the page of a command; the page of the program lists the commands.
std::string man_page(const CommandInfo& command, const std::vector<CommandInfo>& commands);

}  // namespace awmr::cli
