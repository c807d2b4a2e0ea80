/// Findings about delays, filters and constant errors of commands and sensors. Private to
/// identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// Returns one finding for each significant term that the fit identifies
/// (LogFit::is_significant()). A term is a delay, a lag, an error of commands or sensors, or a
/// force of extra_forces.h (force_findings()). `withdrawn`: true if the fit has no valid intervals;
/// the messages then say so. `file`: log file that the findings name.
std::vector<Finding> command_and_sensor_findings(const LogFit& fit, bool withdrawn,
                                                 const std::string& file);

/// True if the fit has found a large saturation of the forces: the largest command loses more than
/// 5 % of its force, or the exponent of the forces is below 0.95. The intervals of such a fit are
/// too narrow, because the true form of the saturation is unknown. A wrong form makes the force of
/// small commands wrong, and with it all other values.
bool saturates_much(const LogFit& fit);

/// True if left and right forces of the fit differ from their mean by more than 25 %, which is more
/// than real motors do. Another error then probably acts like an imbalance, and the intervals are
/// not valid. For example, the speed column may be the speed of one wheel, u - d r or u + d r (d:
/// half of the track width, r: yaw rate).
bool has_implausible_imbalance(const LogFit& fit);

}  // namespace awmr
