#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>

#include "awmr/core/files/process.h"
#include "commands.h"
#include "pil_options.h"

namespace awmr::cli {
namespace {

/// Returns the options that the user gave, as arguments for the program awmr-pil.
std::vector<std::string> arguments_of(const CLI::App& command) {
  std::vector<std::string> arguments;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& value : option->results()) {
      const std::string name = "--" + option->get_lnames().front();
      arguments.push_back(
          option->get_items_expected_max() == 0 ? name : fmt::format("{}={}", name, value));
    }
  }
  return arguments;
}

/// Finds awmr-pil next to this program, else in PATH.
std::optional<fs::path> awmr_pil() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (!error && fs::exists(self.parent_path() / "awmr-pil", error)) {
    return self.parent_path() / "awmr-pil";
  }
  return find_program("awmr-pil");
}

/// Replaces this process with the program awmr-pil (exec), so that output and exit code are those
/// of awmr-pil. Returns only if awmr-pil cannot be started.
Result<Outcome> become_awmr_pil(std::vector<std::string> arguments) {
  const auto program = awmr_pil();
  int reason = ENOENT;
  if (program) {
    arguments.insert(arguments.begin(), {"awmr-pil", "run"});
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    ::execv(program->c_str(), argv.data());
    reason = errno;
  }
  return input_error(
      ErrorCode::kNotInstalled, "awmr-pil",
      fmt::format("cannot be started ({}). This program runs the firmware on an emulated chip, "
                  "and a demo build does not have it. Build it: scripts/setup test && "
                  "scripts/build release, then use build/release/bin/awmr",
                  std::strerror(reason)));
}

}  // namespace

void add_pil(CLI::App& app, Session& session) {
  // Variables into which CLI11 writes the options. It does so after this function has returned, so
  // the command keeps them.
  struct Held {
    PilOptions options;
    CLI::App* command = nullptr;
  };
  auto held = std::make_shared<Held>();
  held->command =
      add_command(app, session, "pil",
                  "Run the firmware on an emulated ATmega2560 against the simulated vehicle",
                  "awmr pil --model model.json --gains gains.json --scenario "
                  "configs/paper/scenarios/c3_heading_steps.json --mode combined -o pil.json",
                  [held] { return become_awmr_pil(arguments_of(*held->command)); });
  add_pil_options(*held->command, held->options);
  add_output(*held->command, held->options.output, "pil.json to write");
}

}  // namespace awmr::cli
