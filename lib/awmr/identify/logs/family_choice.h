/// The families of resistance that a fit of logs may have. Private to identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

struct FamilyFit {
  Family surge = Family::kPower;
  LogFitOptions options;  ///< with the terms of the families
  LogFit fit;
};

/// The fit with the families' terms free. `power_law`: the options for a power law in both motions.
FamilyFit fit_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                     Family surge, Family yaw);

struct BestFamily {
  FamilyFit best;
  std::vector<EstimatorReport> others;
  double gain = 0.0;               ///< the power law's AIC less that of the best
  std::optional<Finding> finding;  ///< `power-law-inadequate`: another family is plainly better
};

/// Every family of surge resistance in turn: the least AIC of those that converged.
BestFamily best_family(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                       Family yaw);

}  // namespace awmr
