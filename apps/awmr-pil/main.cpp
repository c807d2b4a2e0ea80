// awmr-pil: `awmr pil`'s work, in a program of its own because libsimavr is under the GPL-3.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "awmr/core/option_text.h"
#include "awmr/core/provenance.h"
#include "executor.h"
#include "pil_options.h"
#include "run.h"
#include "work_folder.h"

namespace {

int report(const awmr::Error& error) {
  awmr::pil::end_if_told_to();
  std::fputs(awmr::to_text(error, "--").c_str(), stderr);
  return awmr::exit_code(error);
}

int run(int argc, char** argv) {
  CLI::App app{"awmr-pil: the firmware on an emulated ATmega2560; started by `awmr pil`."};
  app.set_version_flag("--version", std::string("awmr ") + awmr::version());
  awmr::cli::PilOptions options;
  bool quiet = false;
  std::string terminal_elf;
  CLI::App* serve = app.add_subcommand(
      "serve", "Emulate a board: FIRMWARE.elf's USART on a pseudo-terminal, whose name is printed");
  serve->add_option("FIRMWARE", terminal_elf, "pil_uart.elf of awmr pil --build-dir")->required();
  CLI::App* pil = app.add_subcommand("run", "What `awmr pil` does");
  awmr::cli::add_pil_options(*pil, options);
  pil->add_option("-o,--output", options.output, "pil.json to write")->required();
  pil->add_flag("--quiet", quiet, "Print errors only");
  app.require_subcommand(1);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  if (serve->parsed()) {
    const auto served = awmr::pil::serve_terminal(terminal_elf);
    return served ? 0 : report(served.error());
  }
  const auto outcome = awmr::pil::run_pil(options);
  if (!outcome) return report(outcome.error());
  if (!quiet || !outcome->passed) std::fputs(outcome->summary.c_str(), stdout);
  return outcome->passed ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  awmr::pil::clean_up_at_signals();
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    awmr::pil::end_if_told_to();
    std::fprintf(stderr, "error: a fault of the program: %s\n", error.what());
    return 3;
  }
}
