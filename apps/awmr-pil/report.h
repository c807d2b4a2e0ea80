/// Acceptance checks of a run on the chip, and their report.
#pragma once

#include <algorithm>
#include <cstddef>
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
  /// Results of the hostile steps. Absent if there are none: `hostile_steps` is 0, the run has an
  /// injection, or the board is real.
  std::optional<Hostile> hostile;
  std::uint8_t start_fault = 0;  ///< fault of the firmware's check at its start; 0: none
  /// Simulated time divided by the time that it took: processor time of the emulation, or elapsed
  /// time for a real board.
  double real_time_factor = 0.0;
};

/// A check of a run: a value and its upper bound.
struct Check {
  std::string name;
  double value = 0.0;
  double bound = 0.0;
  bool passed = false;
  std::string unit;
};

/// Results of a run with an injected failure, evaluated in the window of steps of
/// injection_window(). If the failure disarms the vehicle, the window is from the autopilot's first
/// fault to the end of the run.
struct Injected {
  std::uint8_t expected = 0;  ///< fault bits of which at least one must be raised
  /// Fault bits of the autopilot that were set in every step of the window. For a failure that
  /// disarms the vehicle: the bits of the first fault.
  std::uint8_t seen = 0;
  /// True: an expected fault was raised in time, or the chip was restarted at the step of an
  /// injected reset.
  bool worked = false;
  /// True: the command was safe (forces 0, wheels straight) in all steps of the window.
  bool safe = true;
  /// True: the autopilot had no fault outside of the window. For a failure that disarms the
  /// vehicle: no fault before the failure.
  bool quiet = true;
};

/// Results of a run and the checks that it must pass.
struct Report {
  ChipRun chip;
  Cycles cycles;
  /// Numbers of the steps before which the chip was restarted.
  std::vector<std::size_t> restarts;
  /// Difference between the runs of the chip and of the host in float; should be 0 in every bit.
  Difference from_float;
  /// Difference between the runs of the chip and of the host in double; absent with an injection.
  std::optional<Difference> from_double;
  /// heading_apart_deg() of the run with the chip and the host's run in double.
  double heading_apart_deg = 0.0;
  /// Effect of float arithmetic: difference between the host's runs in float with powf and in
  /// double.
  std::optional<Difference> by_float32;
  /// Effect of the tables: difference between two runs of the host in float, one with tables and
  /// one with powf.
  std::optional<Difference> by_table;
  std::optional<Injected> injected;
  std::vector<Check> checks;

  bool passed() const {
    return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed; });
  }
};

/// Returns the numbers of the steps before which the chip was restarted, in increasing order.
std::vector<std::size_t> restarts_of(const std::vector<LoopRow>& rows);

/// Checks whether a run shows the faults and the safe commands that its injection must cause.
Injected injected_of(const LoopSetup& setup, const std::vector<LoopRow>& rows);

/// Adds to the report the checks of cycles, memory, differences and faults, each with its bound.
/// `period_cycles`: sample time in clock cycles of the chip. Precondition: cycles_max and
/// heading_max_deg of `options` have values.
void evaluate(const cli::PilOptions& options, double period_cycles, Report& report);

/// Returns the content of pil.json. Errors (input): an input file, whose hash pil.json lists,
/// cannot be read again.
Result<std::string> report_text(const cli::PilOptions& options, const LoopSetup& setup,
                                const Report& report);

/// Formats the report for a terminal.
std::string report_summary(const cli::PilOptions& options, const LoopSetup& setup,
                           const Report& report);

}  // namespace awmr::pil
