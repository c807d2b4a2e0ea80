/// Checks whether the fitted model describes the logs. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/family_choice.h"

namespace awmr {

/// Returns the finding `coloured-residuals` for every channel whose residuals are still correlated
/// in time (p < 0.001) after the drift of the noise model is filtered out. The finding is a warning
/// if the scatter between parts of the logs raised a standard error by 50 % or more, else a note.
std::vector<Finding> autocorrelation_findings(const LogFit& fit, const std::string& file);

/// Result of check_adequacy().
struct Adequacy {
  /// Fits with other families (formulas) of the surge resistance; empty if none was tried.
  std::vector<EstimatorReport> alternatives;
  std::vector<Finding> findings;
  /// True: no interval is valid, because a model error is too large.
  bool withdraws_intervals = false;
  /// True: heading or yaw rate show a model error, for example play of the steering. The time
  /// constant of the servo then has no interval.
  bool withdraws_servo = false;
  /// True: the sway speed or the position, which determine the sway resistance, show a model error.
  bool withdraws_sway = false;
};

/// Checks every channel of the fit `chosen` for a model error (ChannelNoise::of_the_model()). One
/// finding `model-inadequate` lists all channels with such an error. If the speed is among them and
/// `try_families` is true, also fits other families of the surge resistance, and recommends one
/// that is better. `power_law`: options of a fit with power laws in surge and yaw.
Adequacy check_adequacy(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        const FamilyFit& chosen, bool try_families);

}  // namespace awmr
