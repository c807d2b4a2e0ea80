/// Checks whether the fitted model describes the logs. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/family_choice.h"

namespace awmr {

/// Returns the finding `coloured-residuals` for every channel whose residuals are still correlated
/// after whitening (p < 0.001). The finding is a warning if the scatter between parts of the logs
/// raised a standard error by 50 % or more, else a note.
std::vector<Finding> autocorrelation_findings(const LogFit& fit, const std::string& file);

/// Result of check_adequacy().
struct Adequacy {
  std::vector<EstimatorReport> alternatives;  ///< fits of other families, if any
  std::vector<Finding> findings;
  bool withdraws_intervals = false;  ///< true: a model error is so large that no interval is valid
  bool withdraws_sway = false;       ///< true: the sway speed has a model error
};

/// Reports `model-inadequate` for every channel of the fit `chosen` whose residuals show a model
/// error (ChannelNoise::of_the_model()). If the speed is one of these channels and `try_families`
/// is true, also fits the other families of surge resistance, and recommends a family that is
/// better. `power_law`: options of a fit with power laws in surge and yaw.
Adequacy check_adequacy(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        const FamilyFit& chosen, bool try_families);

}  // namespace awmr
