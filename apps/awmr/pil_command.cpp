#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <memory>

#include "commands.h"
#include "pil_options.h"

namespace awmr::cli {
namespace {

/// The options as they were given, for another program's command line.
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

/// awmr-pil beside this program, else on the path. It takes this process over, so that its output
/// and its exit code are the command's.
Result<Outcome> become_awmr_pil(const std::vector<std::string>& arguments) {
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path() / "awmr-pil";
  std::vector<char*> argv{const_cast<char*>("awmr-pil"), const_cast<char*>("run")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  ::execv(beside.c_str(), argv.data());
  ::execvp("awmr-pil", argv.data());
  return input_error("awmr-pil",
                     fmt::format("cannot be started ({}); it runs the firmware on an emulated chip "
                                 "and is built where libsimavr is: apt-get install libsimavr-dev "
                                 "gcc-avr avr-libc, then build awmr again",
                                 std::strerror(errno)));
}

}  // namespace

void add_pil(CLI::App& app, Session& session) {
  auto options = std::make_shared<PilOptions>();
  auto command = std::make_shared<CLI::App*>(nullptr);
  *command =
      add_command(app, session, "pil",
                  "Run the firmware on an emulated ATmega2560 against the simulated vehicle",
                  "awmr pil --model model.json --gains gains.json --scenario "
                  "configs/paper/scenarios/c3_heading_steps.json --mode combined -o pil.json",
                  [command] { return become_awmr_pil(arguments_of(**command)); });
  add_pil_options(**command, *options);
  add_output(**command, options->output, "pil.json to write");
}

}  // namespace awmr::cli
