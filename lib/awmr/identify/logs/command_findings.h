/// Findings about delays, filters and constant errors of commands and sensors. Private to
/// identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// Returns one finding for each term that the fit identifies and that is significant
/// (LogFit::is_significant()). A term is a delay, a lag, an error of commands or sensors, or a
/// force of extra_forces.h (force_findings()). `withdrawn`: true if the intervals of the fit are
/// withdrawn; the messages then state this. `file`: log file that the findings name.
std::vector<Finding> command_and_sensor_findings(const LogFit& fit, bool withdrawn,
                                                 const std::string& file);

/// True if the fit has found a large saturation of the forces: more than 5 % of the force is lost
/// at the largest command, or the exponent of the forces is below 0.95. The intervals of such a fit
/// are too narrow, because the true form of the saturation is unknown. A wrong form makes the force
/// of small commands wrong, and with it all other values.
bool saturates_much(const LogFit& fit);

/// True if the fit has found left and right forces that differ more from their mean than those of
/// real motors (by more than 25 %). Another error has then probably taken this form, for example a
/// speed that is measured at one wheel, u -+ d r; the intervals are not valid.
bool has_implausible_imbalance(const LogFit& fit);

}  // namespace awmr
