/// Initial guess of the parameters for logs that have positions and headings, but no speeds, as
/// those of motion capture. Private to identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/model/vehicle.h"
#include "awmr/trials/log.h"

namespace awmr {

/// Exponent b of the guessed resistance laws.
inline constexpr double kGuessedBeta = 0.8;

/// Guess of the inertia and the coefficient alpha of inertia w_dot + alpha |w|^b sgn w = force,
/// with b = kGuessedBeta. Surge: m', a1, w = u; yaw: I'z, a3, w = r.
struct GuessedLaw {
  double inertia;
  double alpha;
};

/// Guesses m' and a1 from the slopes of the positions. Empty if a log has a measured speed, or if
/// the positions and forces do not show both.
std::optional<GuessedLaw> surge_of_positions(const std::vector<DrivingLog>& logs,
                                             const Vehicle& vehicle);

/// Guesses I'z and a3 from the slope of the heading. Empty if a log has a measured yaw rate, or if
/// the heading and the yaw moments do not show both.
std::optional<GuessedLaw> yaw_of_headings(const std::vector<DrivingLog>& logs,
                                          const Vehicle& vehicle);

}  // namespace awmr
