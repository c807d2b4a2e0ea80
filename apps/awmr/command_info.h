/// Describes all commands as data, from which completions and manual pages are generated. The data
/// come from the CLI11 definitions that also parse the options and print `--help`.
#pragma once

#include <string>
#include <vector>

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

}  // namespace awmr::cli
