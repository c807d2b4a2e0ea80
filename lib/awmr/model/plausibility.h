/// What a vehicle's numbers say of each other before any trial: sizes, masses and angles that cannot
/// be, and the unit that they were most likely given in.
///
///     mass over the footprint m/(length width)    1 to 5000 kg/m^2: from a toy to a mining truck
///     length over width                           1/5 to 10
///     track 2 d over width                        0.2 to 1.2: the wheels are about where the body ends
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

/// Iz over that of the box of the same mass and size: all mass in the corners makes 3.
inline constexpr Interval kInertiaOverBox{0.05, 3.0};

/// A number that cannot be, or hardly.
struct Implausible {
  std::string pointer;  ///< in vehicle.json: "/half_track_m"
  std::string message;  ///< what was compared, the likely unit and the value that it would make
};

/// In the order of the table above. Where a size or the mass is in another unit, what is left is held
/// against the value that it would be. Empty for any vehicle that can be built.
std::vector<Implausible> implausible_values(const Vehicle& vehicle);

/// Errors (input): every implausible value, each by its place, `place` followed by its pointer.
/// `remedy`: what to do about it, a clause.
Status check_plausible(const Vehicle& vehicle, const std::string& place, const std::string& remedy);

/// The same as findings (`implausible-vehicle`), of a file or, where `file` is empty, of none.
std::vector<Finding> plausibility_findings(const Vehicle& vehicle, Severity severity,
                                           const std::string& file = {});

}  // namespace awmr
