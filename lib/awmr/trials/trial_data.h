/// All trials of one vehicle.
#pragma once

#include <optional>
#include <vector>

#include "awmr/trials/log.h"
#include "awmr/trials/trials.h"

namespace awmr {

struct TrialData {
  std::optional<TrialSet<SurgeRow>> surge = {};
  std::optional<TrialSet<TurningRow>> turning = {};
  std::optional<TrialSet<StopTimeRow>> coastdown = {};
  std::vector<CoastCurve> curves = {};
  std::vector<DrivingLog> logs = {};
};

}  // namespace awmr
