/// Initial guess of a log fit without other trials. Private to identify/.
#pragma once

#include <vector>

#include "awmr/model/plant_of.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Orders of magnitude from the logs themselves: resistance balances the mean thrust at the mean
/// speed, inertia makes time constants of a third of a second. Terms that only some families have
/// are zero.
ParameterValues<double> guess_from_logs(const std::vector<DrivingLog>& logs,
                                        const Vehicle& vehicle);

}  // namespace awmr
