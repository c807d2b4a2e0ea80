/// Describes all commands as data, and generates completion scripts and manual pages from them. The
/// data come from the definitions (in the library CLI11) that also parse the options and print
/// `--help`.
#pragma once

#include <string>
#include <vector>

#include "awmr/core/name_table.h"

namespace CLI {
class App;
}  // namespace CLI

namespace awmr::cli {

/// Kind of an option's value; shell completion depends on it.
enum class ValueKind {
  kNone,    ///< a flag, without a value
  kOther,   ///< free number or text
  kChoice,  ///< one of `choices`
  kFile,
  kDirectory,
};

struct OptionInfo {
  /// Name as on the command line: "--output"; for a positional argument "PROJECT".
  std::string name;
  std::string short_name;  ///< "-o", or empty
  ValueKind kind = ValueKind::kNone;
  std::string value;                 ///< placeholder of the value: "FILE", "INT", ...
  std::vector<std::string> choices;  ///< with kChoice
  std::string range;                 ///< range of a number: "in [0, 1000]", or empty
  std::string meaning;
  bool positional = false;
  bool required = false;
  bool repeats = false;
};

struct CommandInfo {
  std::string name;  ///< empty for the program itself
  std::string meaning;
  std::string footer;  ///< help text below the options, such as examples
  std::vector<OptionInfo> options;
};

/// Describes the program itself, and after it each command, in the order of the help.
std::vector<CommandInfo> commands_of(const CLI::App& app);

/// Shells for which there is a script that completes commands, options, choices and files.
enum class Shell { kBash, kZsh, kFish };
inline constexpr NameTable<Shell, 3> kShellNames{
    {{"bash", Shell::kBash}, {"zsh", Shell::kZsh}, {"fish", Shell::kFish}}};

/// Returns the completion script for a shell. `commands`: result of commands_of().
std::string completion_text(Shell shell, const std::vector<CommandInfo>& commands);

/// Returns the name of the manual page: "awmr" for the program, "awmr-identify" for a command.
std::string page_name(const CommandInfo& command);

/// Returns the manual page of a command in man(7) format. For the program itself, the page lists
/// all commands.
std::string man_page(const CommandInfo& command, const std::vector<CommandInfo>& commands);

}  // namespace awmr::cli
