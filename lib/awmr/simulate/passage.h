/// Checks whether a passage between obstacles to a target exists, before the vehicle drives there.
#pragma once

#include <vector>

#include "awmr/control/guidance/obstacles.h"

namespace awmr {

/// True if a point can move from `from` to `to` without entering an obstacle that is enlarged by
/// `grow_m` (a disc). Exact except for passages of zero width.
///
/// Method: the two points are separated if and only if a closed chain of overlapping discs
/// encircles exactly one of them. Such a chain crosses the segment from `from` to `to` an odd
/// number of times. A disc that contains one of the points is shrunk so that the point is outside.
bool passage_exists(const std::vector<Obstacle<double>>& obstacles, double grow_m,
                    const Position<double>& from, const Position<double>& to);

}  // namespace awmr
