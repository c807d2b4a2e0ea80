/// All trials of one vehicle.
#pragma once

#include <optional>
#include <vector>

#include "awmr/model/record.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Each kind that is absent or empty was not given.
struct TrialData {
  std::optional<TrialSet<SurgeRow>> surge = {};
  std::optional<TrialSet<TurningRow>> turning = {};
  std::optional<TrialSet<StopTimeRow>> coastdown = {};  ///< coast-downs that were timed
  std::vector<CoastCurve> curves = {};                  ///< coast-downs that were recorded
  std::vector<DrivingLog> logs = {};
};

/// Trials as read, with what is doubtful about them.
struct Trials {
  Vehicle vehicle;
  TrialData data;
  std::vector<Finding> findings;  ///< in this order: surge, turning, coast-downs, logs
};

}  // namespace awmr
