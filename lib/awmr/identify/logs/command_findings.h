/// Findings on delays, filters and constant errors of commands and sensors. Private to identify/.
#pragma once

#include <string>
#include <vector>

#include "awmr/identify/logs/log_fit.h"

namespace awmr {

/// Findings of an identified delay, lag or error: `sensor-delay`, `sensor-lag`, `steering-delay`,
/// `steering-trim`, `force-imbalance`, `actuator-lag`, `late-commands`. `withdrawn`: the intervals of
/// the fit are withdrawn. `file`: the log named in the findings.
std::vector<Finding> command_and_sensor_findings(const LogFit& fit, bool withdrawn,
                                                 const std::string& file);

}  // namespace awmr
