/// What a run on the chip is judged by, and how that is told.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "comparison.h"
#include "executor.h"
#include "hostile.h"
#include "loop.h"
#include "pil_options.h"

namespace awmr::pil {

/// A run of the loop with the chip in it.
struct ChipRun {
  std::vector<LoopRow> rows;
  ChipFigures figures;
  std::optional<Hostile> hostile;  ///< absent with an injection and of a real board
  std::uint8_t start_fault = 0;
  double real_time_factor = 0.0;  ///< simulated time over the time that it took
};

/// One thing to be held against its bound.
struct Check {
  std::string name;
  double value = 0.0;
  double bound = 0.0;
  bool passed = false;
  std::string unit;
};

/// What an injected fault did.
struct Injected {
  std::uint8_t expected = 0;
  std::uint8_t seen = 0;  ///< bits that were set on every sample of the window
  bool worked = false;    ///< the fault was raised, or the chip was taken up after its reset
  bool safe = true;       ///< forces 0 and wheels straight over the whole window
  bool quiet = true;      ///< no fault outside the window
};

/// All that is known of a run, and the checks that it has to pass.
struct Report {
  ChipRun chip;
  Cycles cycles;
  std::vector<std::size_t> restarts;  ///< samples before which the chip was started anew
  Difference from_float;
  std::optional<Difference> from_double;  ///< absent with an injection
  double heading_apart_deg = 0.0;         ///< from the double run, give or take a sample
  std::optional<Difference> by_float32;   ///< float by powf against double
  std::optional<Difference> by_table;     ///< float by table against float by powf
  std::optional<Injected> injected;
  std::vector<Check> checks;

  bool passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed; });
  }
};

/// Adds the checks to the report: cycles, memory, differences and faults, each with its bound.
/// `period_cycles` is the sample time in cycles of the chip's clock.
void judge(const cli::PilOptions& options, double period_cycles, Report& report);

/// The bytes of pil.json. Errors (input): an input cannot be read again.
Result<std::string> report_text(const cli::PilOptions& options, const LoopSetup& setup,
                                const Report& report);

/// The report for a terminal.
std::string report_summary(const cli::PilOptions& options, const LoopSetup& setup,
                           const Report& report);

}  // namespace awmr::pil
