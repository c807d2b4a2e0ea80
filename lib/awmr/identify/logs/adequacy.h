/// Checks whether the fitted model describes the logs. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/family_choice.h"

namespace awmr {

/// The finding `coloured-residuals` for every channel whose residuals are correlated after
/// whitening. A warning if this widened the standard errors by 50 % or more, else a note.
std::vector<Finding> autocorrelation_findings(const LogFit& fit, const std::string& file);

/// Result of check_adequacy().
struct Adequacy {
  std::vector<EstimatorReport> alternatives;  ///< fits of other families, if any
  std::vector<Finding> findings;
  bool withdraws_intervals = false;  ///< the model error is so large that the intervals are invalid
};

/// Reports `model-inadequate` for every channel of the fit `chosen` whose residuals show a model
/// error (ChannelNoise::of_the_model()). If the speed is one of these channels and `try_families`
/// is true, also fits the other families of surge resistance. `power_law`: options of a fit of
/// power laws.
Adequacy check_adequacy(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        const FamilyFit& chosen, bool try_families);

}  // namespace awmr
