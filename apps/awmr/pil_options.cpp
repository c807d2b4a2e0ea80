#include "pil_options.h"

#include <CLI/CLI.hpp>
#include <limits>
#include <string>

#include "awmr/simulate/scenario.h"
#include "emit_options.h"
#include "option_values.h"

namespace awmr::cli {
namespace {

constexpr unsigned kAnyCount = std::numeric_limits<unsigned>::max();

void add_inputs(CLI::App& command, PilOptions& options) {
  add_file(command, "--model", options.model, "model.json from identify")->required();
  add_file(command, "--gains", options.gains, "gains.json from tune")->required();
  add_file(command, "--scenario", options.scenario, "scenario.json")->required();
  add_choice(command, "--mode", options.mode, kYawModeNames,
             "Yaw control by wheel forces, by steering or by both")
      ->required();
}

void add_link(CLI::App& command, PilOptions& options) {
  add_choice(command, "--link", options.link, kPilLinkNames,
             "How this computer and the chip exchange data: memory: through the chip's RAM (fast); "
             "uart: in frames over its serial line, as with a real board")
      ->default_str("memory");
  add_file(command, "--port", options.port,
           "Serial port of a real board, flashed with DIR/pil_uart.elf of --build-dir; "
           "with --link uart");
  command.add_option("--baud", options.baud, "Baud rate of --port")
      ->check(within(300U, 4000000U))
      ->capture_default_str();
}

void add_bounds(CLI::App& command, PilOptions& options) {
  command
      .add_option("--cycles-max", options.cycles_max,
                  "Largest permitted clock cycles of a control step [13000 with resistance "
                  "tables, 24000 with powf; with optional parts or a position estimate, 75 % of "
                  "the sample time]")
      ->check(within(1U, kAnyCount));
  command.add_option("--flash-max", options.flash_max, "Largest permitted bytes of flash")
      ->check(within(1U, kAnyCount))
      ->capture_default_str();
  command
      .add_option("--ram-max", options.ram_max, "Largest permitted bytes of RAM, without the stack")
      ->check(within(1U, kAnyCount))
      ->capture_default_str();
  command
      .add_option(
          "--difference-max", options.difference_max,
          "Largest permitted difference of any signal between the chip's run and the same "
          "run in float on this computer [0 with --resistance table, 1e-6 with --resistance powf]")
      ->check(within(0.0, 1e9));
  command
      .add_option("--heading-max-deg", options.heading_max_deg,
                  "Largest permitted heading difference, deg, between the chip's run and the same "
                  "run in double on this computer, at the same or a neighbouring sample [0.05; 2 "
                  "if obstacles are avoided or sensors simulated]")
      ->check(within(0.0, 360.0));
}

}  // namespace

void add_pil_options(CLI::App& command, PilOptions& options) {
  add_inputs(command, options);
  add_link(command, options);
  add_emit_options(command, options.emit);
  add_choice(
      command, "--optimize", options.optimize, kOptimizeNames,
      "Compile the firmware for few clock cycles (speed) or for little flash (size) [size for "
      "a timed path, obstacles, or two optional parts or more; else speed]");
  add_bounds(command, options);
  command
      .add_option("--hostile-steps", options.hostile_steps,
                  "Number of steps with extreme or invalid inputs after the scenario, to find the "
                  "longest step; 0: none")
      ->check(within(0U, 10000000U))
      ->capture_default_str();
  add_choice(command, "--inject", options.injection, kInjectionNames,
             "Fault to inject; most faults begin in the middle of the run")
      ->default_str("none");
  command
      .add_option("--line-noise", options.line_noise,
                  "Fraction of bits flipped and of bytes lost on the emulated UART")
      ->check(within(0.0, 0.5))
      ->capture_default_str();
  add_directory(command, "--build-dir", options.build_directory,
                "Keep the firmware in this directory");
}

}  // namespace awmr::cli
