#include "command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "awmr/core/nearest.h"
#include "awmr/core/text.h"

namespace awmr::cli {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// Returns `--NAME` of each option of the command, as candidates for a misspelt name. One-letter
/// options are left out, because they are close to every short word.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// Returns the first argument that looks like an option but is unknown. In `--NAME=VALUE`, only
/// `--NAME` is returned.
std::optional<std::string> unknown_option(const CLI::App& command) {
  const std::vector<std::string> words = command.remaining();
  const auto found = std::find_if(words.begin(), words.end(), [](const std::string& word) {
    return word.size() > 1 && word.front() == '-' && word != "--";
  });
  if (found == words.end()) return std::nullopt;
  return found->substr(0, found->find('='));
}

}  // namespace

bool has_unknown_command(const CLI::App& app, int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  const std::vector<std::string> names = command_names(app);
  return !first.empty() && first.front() != '-' &&
         std::find(names.begin(), names.end(), first) == names.end();
}

std::string usage_error_text(const CLI::App& app, const CLI::ParseError& error, int argc,
                             char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (app.get_subcommands().empty() && !first.empty() && first.front() != '-') {
    return fmt::format("no command is called '{}'{}", shortened(first),
                       did_you_mean(first, command_names(app)));
  }
  if (app.get_subcommands().empty() && !first.empty()) {
    return fmt::format("'{}' comes before the command{}", shortened(first),
                       did_you_mean(first, option_names(app)));
  }
  for (const CLI::App* command : app.get_subcommands()) {
    if (const auto option = unknown_option(*command)) {
      return fmt::format("{} has no option '{}'{}", command->get_name(), shortened(*option),
                         did_you_mean(*option, option_names(*command)));
    }
  }
  return shortened(error.what());
}

}  // namespace awmr::cli
