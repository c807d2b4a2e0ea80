/// Acceptance checks of a run on the chip, and their report.
#pragma once

#include <algorithm>
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

/// Closed-loop run with the chip.
struct ChipRun {
  std::vector<LoopRow> rows;
  ChipFigures figures;
  /// Absent without hostile steps, with an injection, and for a real board.
  std::optional<Hostile> hostile;
  std::uint8_t start_fault = 0;   ///< fault of the firmware's check at its start; 0: none
  double real_time_factor = 0.0;  ///< simulated time over processor time (board: elapsed time)
};

/// A check of a run: a value and its upper bound.
struct Check {
  std::string name;
  double value = 0.0;
  double bound = 0.0;
  bool passed = false;
  std::string unit;
};

/// Effect of an injected fault. The "window" is that of injection_window(); for a failure that
/// disarms the vehicle it extends from the first fault of the autopilot to the end of the run.
struct Injected {
  std::uint8_t expected = 0;  ///< fault bits of which at least one must be raised
  std::uint8_t seen = 0;      ///< bits set on every sample of the window, or by the first fault
  bool worked = false;        ///< an expected fault was raised in time, or the chip restarted
  bool safe = true;           ///< forces 0 and wheels straight during the whole window
  bool quiet = true;          ///< no fault of the autopilot outside of the window (with a failure:
                              ///< before it)
};

/// Results of a run and the checks that it must pass.
struct Report {
  ChipRun chip;
  Cycles cycles;
  std::vector<std::size_t> restarts;      ///< samples before which the chip was restarted
  Difference from_float;                  ///< difference of the chip's run from the same run in
                                          ///< float on the host
  std::optional<Difference> from_double;  ///< difference of the chip's run from the run in double
                                          ///< on the host; absent with an injection
  double heading_apart_deg = 0.0;         ///< heading_apart_deg() of the chip's run and the run in
                                          ///< double on the host
  std::optional<Difference> by_float32;   ///< difference of two runs on the host: float with powf,
                                          ///< and double
  std::optional<Difference> by_table;     ///< difference of two runs in float on the host: with
                                          ///< tables, and with powf
  std::optional<Injected> injected;
  std::vector<Check> checks;

  bool passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed; });
  }
};

/// Adds the checks of cycles, memory, differences and faults to the report, each with its bound.
/// `period_cycles`: sample time in cycles of the chip's clock. Precondition: `options` has the
/// bounds of cycles and heading.
void evaluate(const cli::PilOptions& options, double period_cycles, Report& report);

/// Returns the content of pil.json. Errors (input): an input cannot be read again.
Result<std::string> report_text(const cli::PilOptions& options, const LoopSetup& setup,
                                const Report& report);

/// Formats the report for a terminal.
std::string report_summary(const cli::PilOptions& options, const LoopSetup& setup,
                           const Report& report);

}  // namespace awmr::pil
