#include "command_info.h"

#include <CLI/CLI.hpp>
#include <sstream>

#include "option_values.h"

namespace awmr::cli {
namespace {

/// Returns the names a and b of a type text "TEXT:{a,b}" of one_of(); empty without braces.
std::vector<std::string> choices_in(const std::string& type) {
  std::vector<std::string> names;
  const std::size_t open = type.find('{');
  if (open == std::string::npos) return names;
  std::istringstream list(type.substr(open + 1, type.find('}') - open - 1));
  for (std::string name; std::getline(list, name, ',');) names.push_back(name);
  return names;
}

ValueKind kind_of(const OptionInfo& option) {
  if (!option.choices.empty()) return ValueKind::kChoice;
  if (option.value == kFileValue) return ValueKind::kFile;
  if (option.value == kDirectoryValue) return ValueKind::kDirectory;
  return ValueKind::kOther;
}

OptionInfo info_of(const CLI::Option& option) {
  OptionInfo info;
  info.positional = option.get_positional();
  info.name = info.positional ? option.get_name(true) : "--" + option.get_lnames().front();
  if (!option.get_snames().empty()) info.short_name = "-" + option.get_snames().front();
  info.meaning = option.get_description();
  info.required = option.get_required();
  if (option.get_items_expected_max() == 0) return info;
  // CLI11 returns the type with its range or its choices: "INT:in [0, 1000]", "TEXT:{a,b}", "FILE".
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  info.value = type.substr(0, colon);
  info.choices = choices_in(type);
  if (!info.choices.empty()) info.value = "NAME";
  info.kind = kind_of(info);
  if (colon != std::string::npos && info.choices.empty()) info.range = type.substr(colon + 1);
  info.repeats = option.get_expected_max() > 1;
  return info;
}

CommandInfo info_of(const CLI::App& command) {
  CommandInfo info{.name = command.get_parent() != nullptr ? command.get_name() : "",
                   .meaning = command.get_description(),
                   .footer = command.get_footer(),
                   .options = {}};
  for (const CLI::Option* option : command.get_options()) info.options.push_back(info_of(*option));
  return info;
}

}  // namespace

std::vector<CommandInfo> commands_of(const CLI::App& app) {
  std::vector<CommandInfo> commands{info_of(app)};
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(info_of(*command));
  return commands;
}

}  // namespace awmr::cli
