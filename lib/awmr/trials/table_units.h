/// Detects wrong units in tables of runs by comparing speeds and times with plausible ranges.
/// Private to this folder.
///
///     quantity                                  expected range
///     speed_mps over distance_m/elapsed_s       1; 3.6, 1000, 0.01, ... identify a unit
///     yaw_rate_radps over 2 pi turns/elapsed_s  1; 57.3, 1000 identify a unit
///     speed of fastest run/vehicle's length     0.02 to 100 1/s: from a crawl to a racing model
///     fastest turn, if timed                    0.01 rad/s and more; upper limit: turn_evidence.h
///     hardest coast-down, mean deceleration     0.01 m/s^2 (the best bearings) and more
///     gentlest coast-down, mean deceleration    20 m/s^2 (locked racing tyres) and less
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
  double times;             ///< the checked rate is too large by this factor with this unit
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

}  // namespace awmr
