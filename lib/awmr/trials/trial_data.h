/// All trials of one vehicle.
#pragma once

#include <optional>
#include <vector>

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

}  // namespace awmr
