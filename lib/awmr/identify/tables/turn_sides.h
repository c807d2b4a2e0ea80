/// Comparison of the left and right turns of a turning table. Private to identify/.
#pragma once

#include <optional>

#include "awmr/identify/tables/subject.h"
#include "awmr/model/record.h"

namespace awmr {

/// The finding `turns-differ` if left and right turns differ as if a constant yaw moment M (over
/// F_max, m; positive to the left) acted on the vehicle, and M is significantly different from 0
/// (level 1 %). Such a moment comes from unequal motors or drag, or from wheels that are out of
/// line. M adds to the moment tau of a left turn and opposes that of a right turn. With the yaw
/// resistance a3 r^b3 at the yaw rate r, and the sign s of the turn (1: left, -1: right),
///
///     tau + s M = a3 r^b3,   for small M: ln tau = ln a3 + b3 ln r - M s/tau
///
/// which is linear in ln a3, b3 and M. Needs two turns to each side and six turns in total. `yaw`:
/// the subject of the turning runs `runs`.
std::optional<Finding> compare_sides(const Subject& yaw, const TrialSet<TurningRow>& runs);

}  // namespace awmr
