/// Scripts for shell completion of commands, options, choices and files.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/name_table.h"
#include "command_info.h"

namespace awmr::cli {

enum class Shell { kBash, kZsh, kFish };
inline constexpr NameTable<Shell, 3> kShellNames{
    {{"bash", Shell::kBash}, {"zsh", Shell::kZsh}, {"fish", Shell::kFish}}};

/// Returns the completion script for a shell. `commands`: result of commands_of().
std::string completion_text(Shell shell, const std::vector<CommandInfo>& commands);

}  // namespace awmr::cli
