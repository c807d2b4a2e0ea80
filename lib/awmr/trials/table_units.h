/// Units of tables of runs, by what speeds and times can be. Private to this folder.
///
///     speed_mps over distance_m/elapsed_s       1; 3.6, 1000, 0.01, ... tell a unit
///     yaw_rate_radps over 2 pi turns/elapsed_s  1; 57.3, 1000 tell a unit
///     fastest run over the vehicle's length     0.02 to 100 1/s: from a crawl to a racing model car
///     fastest turn                              0.01 rad/s and more; turn_evidence.h has the most
///     deceleration of a coast-down              0.01 m/s^2 and more: what the best bearings lose
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "awmr/model/vehicle.h"
#include "awmr/trials/trials.h"
#include "mending.h"

namespace awmr {

/// A column in another unit.
struct WrongUnit {
  int line = 0;                   ///< of the first row
  std::string message;            ///< what was compared, what was found, the likely units
  std::vector<Mending> mendings;  ///< the likeliest first; empty where a mapping mends nothing
  std::string remedy = {};        ///< then this does
};

/// None where the table's units can be what they say; the first that cannot.
std::optional<WrongUnit> wrong_unit(const TrialSet<SurgeRow>& surge, const Vehicle& vehicle);
std::optional<WrongUnit> wrong_unit(const TrialSet<TurningRow>& turning);
/// `surge`: the same vehicle's runs, which tell how fast it can be.
std::optional<WrongUnit> wrong_unit(const TrialSet<StopTimeRow>& coastdown,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle);
std::optional<WrongUnit> wrong_unit(const std::vector<CoastCurve>& curves,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle);

}  // namespace awmr
