// Program awmr-pil, which executes `awmr pil`. It is separate because libsimavr is under the GPL-3.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "awmr/core/option_text.h"
#include "awmr/core/provenance.h"
#include "executor.h"
#include "findings_text.h"
#include "json_output.h"
#include "pil_options.h"
#include "progress.h"
#include "run.h"
#include "work_folder.h"

namespace {

int report(const awmr::Error& error, bool json = false) {
  awmr::pil::exit_if_interrupted();
  const std::string text = json ? awmr::cli::error_text(error) : awmr::to_text(error, "--");
  std::fputs(text.c_str(), stderr);
  return awmr::exit_code(error);
}

/// Runs the command. On a terminal, also displays the current stage of the work and the time left.
awmr::Result<awmr::pil::Outcome> watched(const awmr::cli::PilOptions& options) {
  awmr::cli::Working working("reading");
  return awmr::pil::run_pil(
      options, {.doing = [&](std::string_view what) { working.doing(what); },
                .progress = [&](std::size_t done, std::size_t total) { working(done, total); }});
}

int exit_code_of(const awmr::pil::Outcome& outcome) { return outcome.passed ? 0 : 1; }

void print(const awmr::pil::Outcome& outcome, const std::filesystem::path& output, bool quiet,
           bool json) {
  const std::string text = json ? awmr::cli::result_text({.command = "pil",
                                                          .exit_code = exit_code_of(outcome),
                                                          .written = {output},
                                                          .findings = outcome.findings,
                                                          .document = outcome.document})
                                : outcome.summary;
  if (json || !quiet || !outcome.passed) std::fputs(text.c_str(), stdout);
  if (json || quiet) return;
  const std::string findings = awmr::cli::findings_text(outcome.findings, awmr::cli::Style(stderr));
  std::fputs(findings.c_str(), stderr);
}

int run(int argc, char** argv) {
  CLI::App app{"awmr-pil: the firmware on an emulated ATmega2560; started by `awmr pil`."};
  app.set_version_flag("--version", std::string("awmr ") + awmr::version());
  awmr::cli::PilOptions options;
  bool quiet = false;
  bool json = false;
  std::string terminal_elf;
  CLI::App* serve = app.add_subcommand(
      "serve", "Emulate a board: FIRMWARE.elf's USART on a pseudo-terminal, whose name is printed");
  serve->add_option("FIRMWARE", terminal_elf, "pil_uart.elf of awmr pil --build-dir")->required();
  CLI::App* pil = app.add_subcommand("run", "Implementation of `awmr pil`");
  awmr::cli::add_pil_options(*pil, options);
  pil->add_option("-o,--output", options.output, "pil.json to write")->required();
  pil->add_flag("--quiet", quiet, "Print errors only");
  pil->add_flag("--json", json, "Print the result as one JSON object");
  app.require_subcommand(1);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::fprintf(stderr, "error: %s [usage]\n", error.what());
    return 2;
  }
  if (serve->parsed()) {
    const auto served = awmr::pil::serve_terminal(terminal_elf);
    return served ? 0 : report(served.error());
  }
  awmr::cli::show_progress({.on_terminal = !quiet, .in_lines = false});
  const auto outcome = watched(options);
  if (!outcome) return report(outcome.error(), json);
  print(*outcome, options.output, quiet, json);
  return exit_code_of(*outcome);
}

}  // namespace

int main(int argc, char** argv) {
  awmr::pil::clean_up_at_signals();
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    awmr::pil::exit_if_interrupted();
    std::fprintf(stderr, "error: bug in awmr-pil, please report it: %s [internal]\n", error.what());
    return 3;
  }
}
