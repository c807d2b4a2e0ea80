/// Does the model describe the logs? Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/family_choice.h"

namespace awmr {

/// `coloured-residuals` for every channel whose residuals stay correlated after the whitening: a
/// warning where the standard errors had to be widened by half or more for it.
std::vector<Finding> autocorrelation_findings(const LogFit& fit, const std::string& file);

struct Adequacy {
  std::vector<EstimatorReport> alternatives;  ///< other families, where they were tried
  std::vector<Finding> findings;
  bool withdraws_intervals = false;  ///< no interval of this model holds for the vehicle
};

/// `model-inadequate` for every channel whose errors are the model's own, not the sensor's. Where
/// that is the speed and `try_families`, the other families of surge resistance are fitted too.
Adequacy judge_adequacy(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        const FamilyFit& chosen, bool try_families);

}  // namespace awmr
