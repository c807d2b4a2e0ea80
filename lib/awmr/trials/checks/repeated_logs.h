/// Detects recordings that were given twice: copies, or files that have a part in common. A
/// recording that counts twice makes confidence intervals too narrow, by a factor of up to sqrt(2).
/// Private to trials/.
///
/// The test compares the commands and measured channels that both logs have, each rounded to the
/// coarser of its two resolutions. It therefore also finds copies with fewer digits, fewer columns,
/// other names or another time origin. It compares only rows in which a measurement changes, with
/// the time offset for which most of these rows agree. The logs have a part in common if at least
/// 50 rows agree, and at least 95 % of the rows between the first and the last row that agree. The
/// test finds exact copies of any length.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Adds a fault (kGivenTwice) for each log that has a part in common with an earlier log. Accepts
/// logs that agree only at their beginning, because simulations that start with the same commands
/// do so.
void check_repeated_logs(const std::vector<DrivingLog>& logs, std::vector<Fault>& faults);

/// Adds a fault (kGivenTwice) for each curve of 20 speeds or more that repeats an earlier one
/// exactly. The times of the two curves may differ by a constant offset.
void check_repeated_curves(const std::vector<CoastCurve>& curves, std::vector<Fault>& faults);

}  // namespace awmr
