/// Initial guess of the parameters for a log fit without other trials. Private to identify/.
#pragma once

#include <vector>

#include "awmr/model/plant_of.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Guesses the order of magnitude of each parameter: resistances that balance the mean forces at
/// the mean speeds, and m' and I'z for time constants of a third of a second. Terms that only some
/// families have are 0.
ParameterValues<double> guess_from_logs(const std::vector<DrivingLog>& logs,
                                        const Vehicle& vehicle);

}  // namespace awmr
