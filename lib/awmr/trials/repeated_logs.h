/// Detects recordings that were given twice: copies, or files that have a part in common. A
/// recording that counts twice makes confidence intervals too narrow, by a factor of up to sqrt(2).
/// Private to this folder.
///
/// Two logs are compared in the commands and measured channels that both have. Each quantity is
/// rounded to the coarser of its two resolutions. Copies with fewer digits, fewer columns, other
/// names or another time origin are therefore found too. Only rows in which a measurement changes
/// are compared. The test first finds the time offset between the logs with which most of them
/// agree. The logs have a part in common if at least 50 of these rows agree, and at least 95 % of
/// those between the first and the last that agree. Exact copies are found at any length.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Adds a fault (kGivenTwice) for each log that has a part in common with an earlier one. Logs that
/// agree only at their beginning are accepted: they are separate simulations that started with the
/// same commands.
void check_repeated_logs(const std::vector<DrivingLog>& logs, std::vector<Fault>& faults);

/// Adds a fault (kGivenTwice) for each curve of 20 speeds or more that repeats an earlier one
/// exactly. The times of the two curves may differ by a constant offset.
void check_repeated_curves(const std::vector<CoastCurve>& curves, std::vector<Fault>& faults);

}  // namespace awmr
