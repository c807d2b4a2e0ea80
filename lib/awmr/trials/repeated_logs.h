/// Detects recordings that were given twice, as copies or as files with a part in common. A copy
/// makes confidence intervals too narrow, up to sqrt(2) times. Private to this folder.
///
/// Two logs are compared in the measured channels and commands that both have, each rounded to the
/// coarser of its two resolutions, so that a copy with fewer digits or columns, other names or
/// another start of the time is found too. The offset of the times at which most rows agree is
/// tested: the logs have a part in common if 95 % of the rows there agree. Only rows in which a
/// measurement changes count, and at least 50 of them. Exact copies are found at any length.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Adds a fault (kGivenTwice) for each log that has a part in common with an earlier one. Logs that
/// agree only from their first row on for some time are separate simulations with the same
/// commands, and are accepted.
void check_repeated_logs(const std::vector<DrivingLog>& logs, std::vector<Fault>& faults);

/// Adds a fault (kGivenTwice) for each curve of 20 speeds or more that repeats an earlier one
/// exactly, apart from the start of the time.
void check_repeated_curves(const std::vector<CoastCurve>& curves, std::vector<Fault>& faults);

}  // namespace awmr
