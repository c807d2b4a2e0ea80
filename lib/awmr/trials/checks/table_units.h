/// Detects wrong units in tables of runs by comparing speeds, yaw rates and times with the ranges
/// in CHECKS.md, "Implausible tables". Private to trials/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "awmr/model/vehicle.h"
#include "awmr/trials/trials.h"
#include "unit_fix.h"

namespace awmr {

/// A unit that a column of a table may have by mistake.
struct ColumnUnit {
  /// The checked quantity (yaw rate, or ratio of printed to timed rate) is this times the right one
  /// if the column has this unit.
  double times;
  std::string_view column;  ///< column to correct
  double factor;            ///< corrected value = value in the file times this
  std::string_view words;
};

struct WrongUnit {
  int line = 0;                     ///< line of the first affected row
  std::string message;              ///< the comparison, its result and the likely units, as text
  std::vector<UnitFix> unit_fixes;  ///< corrections, most likely first; empty if none is known
  std::string remedy = {};          ///< what to do if `unit_fixes` is empty
};

/// Returns the first column with values that are implausible in its unit; empty if there is none.
std::optional<WrongUnit> wrong_unit(const TrialSet<SurgeRow>& surge, const Vehicle& vehicle);
std::optional<WrongUnit> wrong_unit(const TrialSet<TurningRow>& turning);
/// Like wrong_unit() above, but for coast-downs. `surge`: surge runs of the same vehicle, if there
/// are any. The fastest run limits the speed at which a coast-down can begin.
std::optional<WrongUnit> wrong_unit(const TrialSet<StopTimeRow>& coastdown,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle);
std::optional<WrongUnit> wrong_unit(const std::vector<CoastCurve>& curves,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle);

/// Checks that the yaw rates of a turning table are possible with rolling wheels and with the grip
/// of tyres. For each limit, the check takes the row with the largest ratio of yaw rate to limit.
/// If this row violates the limit, it returns the limit and the likely units of the yaw rates, or
/// the single rows that are wrong. Empty if the turns are possible. `surge`: surge runs of the same
/// vehicle; without them, only the limits by grip are checked.
std::optional<WrongUnit> wrong_turn(const TrialSet<TurningRow>& turning,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle);

}  // namespace awmr
