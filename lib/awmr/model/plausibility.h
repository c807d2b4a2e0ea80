/// Consistency checks of a vehicle's numbers before any trial: implausible sizes, masses and
/// angles, and the unit in which they were probably given.
///
///     mass over the footprint m/(length width)    1 to 5000 kg/m^2: from a toy to a mining truck
///     length over width                           1/5 to 10
///     track 2 d over width                        0.2 to 1.2: wheels at the sides of the body
///     front axle l_f over half of the length      0.02 to 1
///     Iz over the box's m (length^2 + width^2)/12 1/20 to 3: all mass in the corners makes 3
///     steering stop                               2 deg and more: 90 deg are 1.6 rad
///     steering rate                               8 deg/s and more: 300 deg/s are 5.2 rad/s
///     steering time constant                      at most 2 s: 20 ms are 20
#pragma once

#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Iz divided by that of a box of the same mass and size: all mass in the corners makes 3.
inline constexpr Interval kInertiaOverBox{0.05, 3.0};
/// Time constant of a steering servo: a larger one is in ms.
inline constexpr double kSlowestServo_s = 2.0;

/// A number that is impossible or very unlikely.
struct Implausible {
  std::string pointer;  ///< in vehicle.json: "/half_track_m"
  std::string message;  ///< the comparison, the likely unit and the resulting value
};

/// In the order of the table above. If a size or the mass is in another unit, the remaining checks
/// use the converted value. Empty for any vehicle that can be built.
std::vector<Implausible> implausible_values(const Vehicle& vehicle);

/// Errors (input): all implausible values, each with its place, which is `place` followed by its
/// pointer. `remedy`: what to do about it, a clause.
Status check_plausible(const Vehicle& vehicle, const std::string& place, const std::string& remedy);

/// The implausible values as findings (`implausible-vehicle`), for a file or, if `file` is empty,
/// for none.
std::vector<Finding> plausibility_findings(const Vehicle& vehicle, Severity severity,
                                           const std::string& file = {});

}  // namespace awmr
