/// The commands as data, taken from the definitions that parse them and make `--help`: what
/// completions and manual pages are written from.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace awmr::cli {

/// What the shell completes a value with.
enum class ValueKind {
  kNone,    ///< a flag, which has no value
  kOther,   ///< a number or a word of the user's own
  kChoice,  ///< one of `choices`
  kFile,
  kDirectory,
};

struct OptionInfo {
  std::string name;        ///< "--output"; of a positional argument "PROJECT"
  std::string short_name;  ///< "-o", or empty
  ValueKind kind = ValueKind::kNone;
  std::string value;                 ///< what stands for the value: "FILE", "INT", ...
  std::vector<std::string> choices;  ///< with kChoice
  std::string range;                 ///< of a number: "in [0, 1000]", or empty
  std::string meaning;
  bool positional = false;
  bool required = false;
  bool repeats = false;
};

struct CommandInfo {
  std::string name;  ///< of the program itself: empty
  std::string meaning;
  std::string footer;  ///< examples, and what else stands below the options
  std::vector<OptionInfo> options;
};

/// The program itself, then each of its commands in the order of the help.
std::vector<CommandInfo> commands_of(const CLI::App& app);

}  // namespace awmr::cli
