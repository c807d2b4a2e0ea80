/// Initial guess of the parameters for a log fit without other trials. Private to identify/.
#pragma once

#include <vector>

#include "awmr/model/plant_of.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Guesses the order of magnitude of each parameter. The guessed surge and yaw resistances balance
/// the root mean square forces at the root mean square speed and yaw rate. The mass m' is 0.3 s
/// times the surge coefficient a1, so that the time constant m'/a1 of the speed is 0.3 s. The yaw
/// inertia I'z is m' times Iz/m of the vehicle. Without measured speeds or yaw rates, the slopes of
/// positions and headings give these guesses (pose_guess.h). Terms that only some resistance
/// families have are 0.
ParameterValues<double> guess_from_logs(const std::vector<DrivingLog>& logs,
                                        const Vehicle& vehicle);

}  // namespace awmr
