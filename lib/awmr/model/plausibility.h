/// Checks a vehicle's numbers before any trial. Finds implausible sizes, masses and angles, and the
/// unit in which they were probably given. The plausible ranges are:
///
///     mass over the footprint m/(length width)    1 to 5000 kg/m^2: from a toy to a mining truck
///     length over width                           1/5 to 10
///     track 2 d over width                        0.2 to 1.2: wheels at the sides of the body
///     front axle l_f over half of the length      0.02 to 1
///     Iz over the box's m (length^2 + width^2)/12 1/20 to 3: all mass in the corners makes 3
///     steering stop                               at least 2 deg; a smaller number is in rad
///     steering rate                               at least 8 deg/s; a smaller number is in rad/s
///     steering time constant                      at most 2 s; a larger number is in ms
#pragma once

#include <string>
#include <vector>

#include "awmr/core/interval.h"
#include "awmr/core/result.h"
#include "awmr/model/model.h"
#include "awmr/model/record.h"
#include "awmr/model/vehicle.h"

namespace awmr {

/// Plausible range of Iz divided by the Iz of a uniform box of the same mass and size. With all
/// mass in the corners, the ratio is 3.
inline constexpr Interval kInertiaOverBox{0.05, 3.0};
/// Largest plausible time constant of a steering servo, s; a larger number is probably in ms.
inline constexpr double kSlowestServo_s = 2.0;

/// Ratio of the identified I'z/m' (yaw inertia to mass) to Iz/m of the vehicle data; 1 if both
/// agree. Precondition: mass_norm > 0.
double inertia_over_vehicle(const Vehicle& vehicle, double inertia_norm, double mass_norm);
/// Range of the ratio above that follows from the 95 % intervals of I'z and m'. If I'z or m' has no
/// interval: from half of the ratio of the values to twice this ratio. Precondition: both estimates
/// have a value.
Interval inertia_over_vehicle(const Vehicle& vehicle, const Estimate& inertia,
                              const Estimate& mass);

/// A number that is impossible or very unlikely.
struct Implausible {
  std::string pointer;  ///< in vehicle.json: "/half_track_m"
  std::string message;  ///< the comparison, the likely unit and the resulting value
};

/// Returns the implausible values; empty if there are none. Checks in this order: length over
/// width, mass and sizes, track, front axle, Iz, steering. If length, width or mass is probably in
/// a wrong unit, the later checks use the value converted to the right unit.
std::vector<Implausible> implausible_values(const Vehicle& vehicle);

/// Checks that the vehicle has no implausible_values(). Errors (input): each of them, at `place`
/// followed by its pointer. `remedy`: sentence at the end of each message, which tells the user
/// what to do.
Status check_plausible(const Vehicle& vehicle, const std::string& place, const std::string& remedy);

/// Returns the implausible values as findings (`implausible-vehicle`) in `file`; if `file` is
/// empty, the findings name no place.
std::vector<Finding> plausibility_findings(const Vehicle& vehicle, Severity severity,
                                           const std::string& file = {});

}  // namespace awmr
