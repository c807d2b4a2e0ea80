/// Whether turns are as fast as wheels and grip allow. Private to this folder.
///
/// Wheels roll no faster than straight ahead with the same force, u of the surge runs, and the wheelbase is
/// longer than l_f:
///
///     by steering   r <= u tan(d_r)/l_f                  side slip changes that by a factor, not by 57
///     by the sides  r <= (u(n F'R) - u(n F'L))/(2 d)
///
/// Grip holds without any surge run. Of speed and rate, v = r R and R >= l_f/tan(d_r):
///
///     by steering   r^2 l_f/tan(d_r) = a <= 60 m/s^2     6 g: twice what a model car spins with
///     by any means  r <= 25 rad/s                        four turns a second
///
/// The fastest row is judged: where it is ten times beyond the middle of all rows, which are possible, it is
/// wrong and not the column.
#pragma once

#include <optional>

#include "awmr/model/vehicle.h"
#include "awmr/trials/trials.h"
#include "table_units.h"

namespace awmr {

/// None where the turns can be; else what they are beyond, with the likely units of the column that the yaw
/// rates are from. `surge`: the same vehicle's runs.
std::optional<WrongUnit> wrong_turn(const TrialSet<TurningRow>& turning,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle);

}  // namespace awmr
