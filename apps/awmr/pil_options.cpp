#include "pil_options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <string>

#include "emit_options.h"

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

/// CLI::Range and CLI::NonNegativeNumber let "nan" pass, which no bound is above or below.
CLI::Validator finite_from_zero() {
  return {[](std::string& text) -> std::string {
            double value = -1.0;
            const bool number = CLI::detail::lexical_cast(text, value);
            if (number && std::isfinite(value) && value >= 0.0) return {};
            return "must be a finite number of at least 0, found " + text;
          },
          "FLOAT >= 0"};
}

/// A whole number from 1 on; CLI11 takes "-1" for the largest one.
CLI::Validator whole_number() {
  return {[](std::string& text) -> std::string {
            double value = 0.0;
            const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
            const bool number = digits && CLI::detail::lexical_cast(text, value);
            if (number && value >= 1.0 && value <= 4294967295.0) return {};
            return "must be a whole number from 1 to 4294967295, found " + text;
          },
          "UINT >= 1"};
}

void add_bounds(CLI::App& command, PilOptions& options) {
  command
      .add_option("--cycles-max", options.cycles_max,
                  "Most cycles of a step [12000 by table, 24000 by powf]")
      ->check(whole_number());
  command
      .add_option("--flash-max", options.flash_max,
                  "Most bytes of flash [8192, with --link uart 9216]")
      ->check(whole_number());
  command.add_option("--ram-max", options.ram_max, "Most bytes of RAM, without the stack")
      ->check(whole_number())
      ->capture_default_str();
  command
      .add_option("--difference-max", options.difference_max,
                  "Largest difference of any signal from the host's float run [0 by table, 1e-6 by "
                  "powf]")
      ->check(finite_from_zero());
  command
      .add_option("--heading-max-deg", options.heading_max_deg,
                  "Largest difference of the heading from the host's double run")
      ->check(finite_from_zero())
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
  command.add_option("--baud", options.baud, "Of --port")->capture_default_str();
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
