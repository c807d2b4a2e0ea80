/// Checks that turns are not faster than rolling wheels and grip allow. Private to this folder.
///
/// Wheels roll no faster than straight ahead with the same force, u of the surge runs, and the
/// wheelbase is longer than l_f:
///
///     by steering   r <= u tan(d_r)/l_f                  side slip: a factor far below 57
///     differential  r <= (u(n F'R) - u(n F'L))/(2 d)
///
/// The limit by grip needs no surge run. With speed v = r R and R >= l_f/tan(d_r):
///
///     by steering   r^2 l_f/tan(d_r) = a <= 60 m/s^2     6 g: twice that of a spinning model car
///     any           r <= 25 rad/s                        four turns a second
///
/// The fastest row is checked. If it exceeds the median of the rows by a factor of ten and the
/// median is possible, the row is wrong, not the column.
#pragma once

#include <optional>

#include "awmr/model/vehicle.h"
#include "awmr/trials/trials.h"
#include "table_units.h"

namespace awmr {

/// Empty if the turns are possible; else the violated limit, with the likely units of the source
/// column of the yaw rates. `surge`: runs of the same vehicle.
std::optional<WrongUnit> wrong_turn(const TrialSet<TurningRow>& turning,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle);

}  // namespace awmr
