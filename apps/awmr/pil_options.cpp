#include "pil_options.h"

#include <CLI/CLI.hpp>
#include <limits>
#include <map>
#include <string>

#include "emit_options.h"
#include "numbers.h"

namespace awmr::cli {
namespace {

const std::map<std::string, YawMode> kModes{{"differential", YawMode::kDifferential},
                                            {"steering", YawMode::kSteering},
                                            {"combined", YawMode::kCombined}};
const std::map<std::string, PilLink> kLinks{{"memory", PilLink::kMemory}, {"uart", PilLink::kUart}};
const std::map<std::string, Injection> kInjections{{"none", Injection::kNone},
                                                   {"nan", Injection::kNaN},
                                                   {"infinite", Injection::kInfinite},
                                                   {"range", Injection::kRange},
                                                   {"mode", Injection::kMode},
                                                   {"heading-stale", Injection::kHeadingStale},
                                                   {"speed-stale", Injection::kSpeedStale},
                                                   {"command-timeout", Injection::kCommandTimeout},
                                                   {"step-late", Injection::kStepLate},
                                                   {"parameters", Injection::kParameters}};

constexpr unsigned kAnyCount = std::numeric_limits<unsigned>::max();

void add_bounds(CLI::App& command, PilOptions& options) {
  command
      .add_option("--cycles-max", options.cycles_max,
                  "Most cycles of a step [12000 by table, 24000 by powf]")
      ->check(within(1U, kAnyCount));
  command
      .add_option("--flash-max", options.flash_max,
                  "Most bytes of flash [8192, with --link uart 9216]")
      ->check(within(1U, kAnyCount));
  command.add_option("--ram-max", options.ram_max, "Most bytes of RAM, without the stack")
      ->check(within(1U, kAnyCount))
      ->capture_default_str();
  command
      .add_option("--difference-max", options.difference_max,
                  "Largest difference of any signal from the host's float run [0 by table, 1e-6 by "
                  "powf]")
      ->check(within(0.0, 1e9));
  command
      .add_option("--heading-max-deg", options.heading_max_deg,
                  "Largest difference of the heading from the host's double run")
      ->check(within(0.0, 360.0))
      ->capture_default_str();
}

}  // namespace

void add_pil_options(CLI::App& command, PilOptions& options) {
  command.add_option("--model", options.model, "model.json from identify")->required();
  command.add_option("--gains", options.gains, "gains.json from tune")->required();
  command.add_option("--scenario", options.scenario, "scenario.json")->required();
  command.add_option("--mode", options.mode, "differential, steering or combined")
      ->required()
      ->transform(CLI::CheckedTransformer(kModes));
  command
      .add_option("--link", options.link,
                  "memory (through the chip's RAM, fast; the default) or uart (framed bytes)")
      ->transform(CLI::CheckedTransformer(kLinks))
      ->default_str("memory");
  command.add_option("--port", options.port,
                     "Serial port of a real board, flashed with DIR/pil_uart.elf of --build-dir; "
                     "with --link uart");
  command.add_option("--baud", options.baud, "Of --port")
      ->check(within(300U, 4000000U))
      ->capture_default_str();
  add_emit_options(command, options.emit);
  add_bounds(command, options);
  command
      .add_option("--inject", options.injection,
                  "A fault to inject half-way: nan, infinite, range, mode, heading-stale, "
                  "speed-stale, command-timeout, step-late, parameters")
      ->transform(CLI::CheckedTransformer(kInjections))
      ->default_str("none");
  command.add_option("--build-dir", options.build_directory, "Keep the firmware in this directory");
}

}  // namespace awmr::cli
