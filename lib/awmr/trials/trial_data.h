/// All trials of one vehicle.
#pragma once

#include <optional>
#include <vector>

#include "awmr/model/record.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Trials by kind. A kind for which no file was given is absent or empty.
struct TrialData {
  std::optional<TrialSet<SurgeRow>> surge = {};
  std::optional<TrialSet<TurningRow>> turning = {};
  std::optional<TrialSet<StopTimeRow>> coastdown = {};  ///< timed coast-downs
  std::vector<CoastCurve> curves = {};                  ///< recorded coast-downs
  std::vector<DrivingLog> logs = {};
};

/// The trials of a vehicle, and the findings from reading them.
struct Trials {
  Vehicle vehicle;
  TrialData data;
  /// Findings of the surge, turning and coast-down files and of the logs, in this order.
  std::vector<Finding> findings;
};

}  // namespace awmr
