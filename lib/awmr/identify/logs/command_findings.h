/// Findings about delays, filters and constant errors of commands and sensors. Private to
/// identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// One finding for each delay, lag or command error that the fit identifies: `sensor-delay`,
/// `sensor-lag`, `steering-delay`, `steering-trim`, `force-imbalance`, `actuator-lag`,
/// `late-commands`. Ignores values below two standard errors, 1 ms, 1 mrad (trim) or 0.1 %
/// (imbalance). `withdrawn`: true if the intervals of the fit are withdrawn, which the messages
/// then state. `file`: the log that the findings name.
std::vector<Finding> command_and_sensor_findings(const LogFit& fit, bool withdrawn,
                                                 const std::string& file);

}  // namespace awmr
