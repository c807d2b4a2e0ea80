/// Checks whether the model describes the logs. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/family_choice.h"

namespace awmr {

/// `coloured-residuals` for every channel whose residuals are still correlated after whitening. A
/// warning if the standard errors were widened by half or more because of it.
std::vector<Finding> autocorrelation_findings(const LogFit& fit, const std::string& file);

struct Adequacy {
  std::vector<EstimatorReport> alternatives;  ///< fits of other families, if any
  std::vector<Finding> findings;
  bool withdraws_intervals = false;  ///< the intervals of this model are invalid
};

/// `model-inadequate` for every channel whose errors are due to the model, not the sensor. If that
/// is the speed and `try_families`, the other families of surge resistance are fitted too.
Adequacy check_adequacy(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        const FamilyFit& chosen, bool try_families);

}  // namespace awmr
