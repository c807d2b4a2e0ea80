// Implements the commands `awmr completion` and `awmr man`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "awmr/core/file.h"
#include "awmr/core/json/json.h"
#include "awmr/core/nearest.h"
#include "command_info.h"
#include "commands.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

/// Outcome of a command that only prints a text; with `--json`, a JSON string.
Outcome text_outcome(std::string text) {
  std::string document = awmr::to_text(Json(text));
  return Outcome{.summary = std::move(text), .document = std::move(document)};
}

/// Writes the manual pages of all commands to a directory.
Result<Outcome> write_pages(const std::vector<CommandInfo>& commands, const fs::path& directory) {
  Outcome outcome;
  std::vector<OutputFile> files;
  for (const CommandInfo& command : commands) {
    files.push_back({directory / (page_name(command) + ".1"), man_page(command, commands)});
    outcome.written.push_back(files.back().path);
  }
  AWMR_RETURN_IF_ERROR(make_directory(directory));
  AWMR_RETURN_IF_ERROR(write_files(files));
  outcome.summary = fmt::format("wrote {} pages to {}\n", files.size(), directory.string());
  return outcome;
}

Result<Outcome> show_page(const std::vector<CommandInfo>& commands, const std::string& name) {
  const auto found = std::find_if(commands.begin(), commands.end(),
                                  [&](const CommandInfo& info) { return info.name == name; });
  if (found != commands.end()) return text_outcome(man_page(*found, commands));
  std::vector<std::string> names;
  for (const CommandInfo& info : commands) names.push_back(info.name);
  return input_error(ErrorCode::kUnknownName, "",
                     fmt::format("no command is called '{}'{}", name, did_you_mean(name, names)));
}

}  // namespace

void add_completion(CLI::App& app, Session& session) {
  auto shell = std::make_shared<Shell>(Shell::kBash);
  CLI::App* sub =
      add_command(app, session, "completion",
                  "Print a script by which a shell completes commands, options and files",
                  "source <(awmr completion bash)", [&app, shell]() -> Result<Outcome> {
                    return text_outcome(completion_text(*shell, commands_of(app)));
                  });
  sub->group(kServiceGroup);
  add_choice(*sub, "SHELL", *shell, kShellNames, "Shell of the completions")->required();
}

void add_man(CLI::App& app, Session& session) {
  struct Words {
    std::string command;
    std::optional<fs::path> directory;
  };
  auto words = std::make_shared<Words>();
  CLI::App* sub = add_command(app, session, "man", "Print the manual page of a command",
                              "awmr man identify | man -l -", [&app, words]() -> Result<Outcome> {
                                const std::vector<CommandInfo> commands = commands_of(app);
                                if (words->directory) {
                                  return write_pages(commands, *words->directory);
                                }
                                return show_page(commands, words->command);
                              });
  sub->group(kServiceGroup);
  auto* command = sub->add_option("COMMAND", words->command,
                                  "Command of the page (default: the program itself)");
  add_directory(*sub, "-o,--output", words->directory, "Write the pages of all commands here")
      ->excludes(command);
}

}  // namespace awmr::cli
