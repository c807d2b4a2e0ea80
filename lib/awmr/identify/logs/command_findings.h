/// Findings about delays, filters and constant errors of commands and sensors. Private to
/// identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// One finding for each delay, lag, error of commands or sensors and force (force_findings()) that
/// the fit identifies. Ignores a value that is below two standard errors, or below the limit for
/// its kind (LogFit::is_significant()).
/// `withdrawn`: true if the intervals of the fit are withdrawn, which the messages then state.
/// `file`: the log that the findings name.
std::vector<Finding> command_and_sensor_findings(const LogFit& fit, bool withdrawn,
                                                 const std::string& file);

/// True if the fit has found a saturation that takes more than 5 % of the force at the largest
/// command, or an exponent of the forces below 0.95. The logs do not show the true form of the
/// saturation, and with it the force of small commands, on which all other values depend: the
/// intervals of the fit are too narrow.
bool saturates_much(const LogFit& fit);

}  // namespace awmr
