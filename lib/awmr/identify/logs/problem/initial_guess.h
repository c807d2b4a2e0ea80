/// Initial guess of the parameters for a log fit without other trials: by magnitudes
/// (initial_guess.cpp), or by slopes of positions and headings (pose_guess.cpp). Private to
/// identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/model/plant_of.h"
#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Guesses the order of magnitude of each parameter. The guessed surge and yaw resistances balance
/// the root mean square forces at the root mean square speed and yaw rate. The mass m' is 0.3 s
/// times the surge coefficient a1, so that the time constant m'/a1 of the speed is 0.3 s. The yaw
/// inertia I'z is m' times Iz/m of the vehicle. Without measured speeds or yaw rates, the slopes of
/// positions and headings give these guesses (surge_of_positions(), yaw_of_headings()). Terms that
/// only some resistance families have are 0.
ParameterValues<double> guess_from_logs(const std::vector<DrivingLog>& logs,
                                        const Vehicle& vehicle);

/// Exponent b of the guessed resistance laws.
inline constexpr double kGuessedBeta = 0.8;

/// Guess of the inertia and the coefficient alpha of inertia w_dot + alpha |w|^b sgn w = force,
/// with b = kGuessedBeta. Surge: m', a1, w = u; yaw: I'z, a3, w = r.
struct GuessedLaw {
  double inertia;
  double alpha;
};

/// Guesses m' and a1 from the slopes of the positions, for logs without speeds, as those of motion
/// capture. Empty if a log has a measured speed, or if the positions and forces do not show both.
std::optional<GuessedLaw> surge_of_positions(const std::vector<DrivingLog>& logs,
                                             const Vehicle& vehicle);

/// Guesses I'z and a3 from the slope of the heading. Empty if a log has a measured yaw rate, or if
/// the heading and the yaw moments do not show both.
std::optional<GuessedLaw> yaw_of_headings(const std::vector<DrivingLog>& logs,
                                          const Vehicle& vehicle);

}  // namespace awmr
