#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "awmr/core/text.h"
#include "commands.h"

namespace {

/// What CLI11 says of the command line; of a command that there is not, its name, which CLI11 leaves
/// out.
std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error, int argc,
                          char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (app.get_subcommands().empty() && !first.empty() && first.front() != '-') {
    return "no command is called '" + awmr::shortened(first) + "'";
  }
  if (app.get_subcommands().empty() && !first.empty()) {
    return "'" + awmr::shortened(first) + "' stands before any command";
  }
  return awmr::shortened(error.what());
}

int run(int argc, char** argv) {
  CLI::App app{
      "awmr: from trial CSVs to tuned gains on the robot.\n"
      "trial CSVs + vehicle.json -> identify -> model.json -> tune -> gains.json -> validate,\n"
      "compare, emit; `awmr run PROJECT.json -o DIR` does all of it."};
  app.name("awmr");
  app.set_version_flag("--version", std::string("awmr ") + awmr::version());
  app.require_subcommand(1);
  app.footer("Example:\n  awmr run configs/paper/project.json -o out");
  app.get_formatter()->column_width(36);

  awmr::cli::Session session;
  awmr::cli::add_run(app, session);
  awmr::cli::add_identify(app, session);
  awmr::cli::add_validate(app, session);
  awmr::cli::add_tune(app, session);
  awmr::cli::add_simulate(app, session);
  awmr::cli::add_compare(app, session);
  awmr::cli::add_merge(app, session);
  awmr::cli::add_emit(app, session);
  awmr::cli::add_pil(app, session);
  awmr::cli::add_report(app, session);
  awmr::cli::add_suggest(app, session);
  awmr::cli::add_recover(app, session);
  awmr::cli::add_map(app, session);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      app.exit(error);
      return std::cout.flush() ? 0 : 2;
    }
    const std::string what = awmr::printable(what_is_wrong(app, error, argc, argv));
    std::fprintf(stderr, "error: %s\nRun `awmr --help` or `awmr COMMAND --help`.\n", what.c_str());
    return 2;
  }
  return session.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  // Beyond a limit of the file size a write then fails, instead of the program being ended.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: a fault of the program: %s\n", error.what());
    return 3;
  }
}
