/// Checks whether the fitted model describes the logs. Private to identify/.
#pragma once

#include <vector>

#include "awmr/identify/logs/family_choice.h"

namespace awmr {

/// Returns one finding `coloured-residuals` for every channel whose whitened residuals are still
/// correlated in time (Ljung-Box test, p < 0.001). Whitening removes the drift of the noise model.
/// The finding is a warning if the scatter between parts of the logs raised a standard error by 50
/// % or more. Otherwise it is a note.
std::vector<Finding> autocorrelation_findings(const LogFit& fit, const std::string& file);

/// Result of check_adequacy().
struct Adequacy {
  /// Fits with other families (forms) of the surge resistance; empty if the check tried none.
  std::vector<EstimatorReport> alternatives;
  std::vector<Finding> findings;
  /// True: a model error is so large that no interval of the fit is valid.
  bool withdraws_intervals = false;
  /// True: heading or yaw rate show a model error, for example play of the steering. The servo's
  /// time constant then gets no interval.
  bool withdraws_servo = false;
  /// True: sway speed or position show a model error. They determine the sway resistance, which
  /// then gets no interval.
  bool withdraws_sway = false;
};

/// Checks every channel of the fit `chosen` for a model error. A channel has one if its residuals
/// (measured minus fitted) have a drift that is too large and too slow to come from the filter of a
/// sensor (ChannelNoise::of_the_model()). One finding `model-inadequate` lists all such channels.
/// If the speed is one of them and `try_families` is true, the check also fits other families of
/// the surge resistance, and recommends a better one. `power_law`: the options of the logs' first
/// fit, which has power laws in surge and yaw; the fits with other families use the same options.
Adequacy check_adequacy(const std::vector<DrivingLog>& logs, const LogFitOptions& power_law,
                        const FamilyFit& chosen, bool try_families);

}  // namespace awmr
