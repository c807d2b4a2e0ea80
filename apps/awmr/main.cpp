#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "awmr/core/files/temporary_file.h"
#include "awmr/core/text.h"
#include "command_line.h"
#include "commands.h"
#include "json_output.h"

namespace {

void describe(CLI::App& app) {
  app.name("awmr");
  app.set_version_flag("--version", std::string("awmr ") + awmr::version());
  app.require_subcommand(1);
  app.footer(
      "Examples:\n  awmr init my_rover        a robot of your own\n"
      "  awmr init --example .     the paper's robot, and then:\n"
      "  awmr run configs/paper/project.json -o out");
  app.get_formatter()->column_width(36);
}

/// Adds the commands in the order of the help.
void add_commands(CLI::App& app, awmr::cli::Session& session) {
  using namespace awmr::cli;
  for (const auto add :
       {add_init,    add_check,    add_run,     add_identify,   add_live, add_validate,
        add_tune,    add_simulate, add_compare, add_merge,      add_emit, add_export,
        add_pil,     add_report,   add_suggest, add_recover,    add_map,  add_log,
        add_compass, add_explain,  add_schema,  add_completion, add_man}) {
    add(app, session);
  }
}

/// Prints the help if it was requested, else the error of the command line. Returns the exit code.
/// Help for an unknown command is an error, too.
int end_of_parsing(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  if (error.get_exit_code() == 0 && !awmr::cli::has_unknown_command(app, argc, argv)) {
    app.exit(error);
    return std::cout.flush() ? 0 : 2;
  }
  // Without arguments, the program prints the help, but returns 2 (usage error): a script whose
  // variable is empty by mistake must fail.
  const std::string what = awmr::printable(awmr::cli::usage_error_text(app, error, argc, argv));
  if (awmr::cli::requests_json(argc, argv)) {
    std::fputs(
        awmr::cli::error_text(awmr::input_error(awmr::ErrorCode::kUsage, "", what).value()).c_str(),
        stderr);
    return 2;
  }
  const std::string help = argc > 1 ? "" : app.help() + "\n";
  std::fprintf(stderr, "%serror: %s [usage]\nRun `awmr --help` or `awmr COMMAND --help`.\n",
               help.c_str(), what.c_str());
  return 2;
}

int run(int argc, char** argv) {
  CLI::App app{
      "awmr: from trial CSVs to tuned gains on the robot.\n"
      "trial CSVs + vehicle.json -> identify -> model.json -> tune -> gains.json -> validate,\n"
      "compare, emit; `awmr run PROJECT.json -o DIR` does all of it."};
  describe(app);
  awmr::cli::Session session;
  add_commands(app, session);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return end_of_parsing(app, error, argc, argv);
  }
  return session.exit_code;
}

int fail(const awmr::Error& error, int argc, char** argv) {
  const std::string text =
      awmr::cli::requests_json(argc, argv) ? awmr::cli::error_text(error) : awmr::to_text(error);
  std::fputs(text.c_str(), stderr);
  return awmr::exit_code(error);
}

}  // namespace

int main(int argc, char** argv) {
  // A file beyond the system's size limit raises SIGXFSZ, which would end the program. If the
  // signal is ignored, the write fails instead, and awmr reports the error.
  std::signal(SIGXFSZ, SIG_IGN);
  awmr::remove_temporaries_on_signals();
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return fail(awmr::input_error(awmr::ErrorCode::kTooLarge, "",
                                  "not enough memory for this input; use fewer samples, runs or "
                                  "rows, or a machine with more memory")
                    .value(),
                argc, argv);
  } catch (const std::exception& error) {
    return fail(
        awmr::program_fault(std::string("fault of the program (please report it): ") + error.what())
            .value(),
        argc, argv);
  }
}
