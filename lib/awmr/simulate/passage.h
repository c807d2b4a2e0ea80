/// Whether obstacles leave a way.
#pragma once

#include <vector>

#include "awmr/control/guidance/obstacles.h"

namespace awmr {

/// Whether a point can get from `from` to `to` outside all discs grown by `grow_m`. Exact, but for
/// a way of no width: the ends are separated exactly where a closed chain of overlapping discs
/// encircles one of them, that is, where a cycle of the graph of overlaps crosses the segment from
/// `from` to `to` an odd number of times. A disc that holds an end is taken as shrunk to leave it.
bool passage_exists(const std::vector<Obstacle<double>>& obstacles, double grow_m,
                    const Position<double>& from, const Position<double>& to);

}  // namespace awmr
