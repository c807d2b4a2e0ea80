/// Checks that the yaw rates of a turning table are possible with rolling wheels and with the grip
/// of tyres. Detects yaw rates in a wrong unit. Private to this folder.
///
/// Limit by rolling. u(tau) is the speed of the surge runs at the thrust tau = n F' of n driven
/// wheels with the force F'. d_r is the steering angle, l_f the distance from the centre of gravity
/// to the front axle, and d half the track width. In a turn, wheels roll no faster than straight
/// ahead with the same force. The wheelbase is longer than l_f, so
///
///     steered       r <= u(n F') tan(d_r)/l_f            up to 3 times as much is accepted
///     differential  r <= (u(n F'R) - u(n F'L))/(2 d)     up to 4 times as much is accepted
///
/// Limit by grip, which needs no surge runs. The turning radius R is at least l_f/tan(d_r), so the
/// centripetal acceleration a = r^2 R is at least r^2 l_f/tan(d_r):
///
///     steered       r^2 l_f/tan(d_r) <= 60 m/s^2         6 g, twice that of a spinning model car
///     any turn      r <= 25 rad/s                        four turns per second
///
/// For each limit, the check takes the row with the largest ratio of yaw rate to limit. If this row
/// violates the limit, the check reports a wrong unit of the column. Exception: if the median row
/// meets the limit and its ratio is less than a tenth of the largest ratio, single rows are wrong,
/// and the check reports the rows beyond the limit. It also reports a wrong unit if all steered
/// turns are below 1 % of u tan(d_r)/l_f.
#pragma once

#include <optional>

#include "awmr/model/vehicle.h"
#include "awmr/trials/trials.h"
#include "table_units.h"

namespace awmr {

/// Returns the limit that the turns violate and the likely units of the yaw rates; empty if the
/// turns are possible. `surge`: surge runs of the same vehicle; without them, only the limits by
/// grip are checked.
std::optional<WrongUnit> wrong_turn(const TrialSet<TurningRow>& turning,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle);

}  // namespace awmr
