/// Checks that the yaw rates of a turning table are possible with rolling wheels and with the grip
/// of tyres. Detects yaw rates in a wrong unit. Private to this folder.
///
/// Limit by rolling. u(tau) is the speed of the surge runs at thrust tau: in a turn, wheels roll no
/// faster than straight ahead with the same force. The wheelbase is longer than l_f, so
///
///     by steering   r <= u(n F') tan(d_r)/l_f            three times that is accepted (drifting)
///     differential  r <= (u(n F'R) - u(n F'L))/(2 d)     four times that is accepted
///
/// Limit by grip, which needs no surge runs. The turning radius R is at least l_f/tan(d_r), so the
/// centripetal acceleration a = r^2 R is at least r^2 l_f/tan(d_r):
///
///     by steering   r^2 l_f/tan(d_r) <= 60 m/s^2         6 g, twice that of a spinning model car
///     any           r <= 25 rad/s                        four turns per second
///
/// For each limit, the row with the largest ratio of yaw rate to limit is checked. If this row
/// violates the limit, but the median row does not and has less than a tenth of its ratio, the rows
/// beyond the limit are reported as wrong. Otherwise the unit of the column is reported. It is also
/// reported if even the largest yaw rate of a steered turn is below 1 % of u tan(d_r)/l_f.
#pragma once

#include <optional>

#include "awmr/model/vehicle.h"
#include "awmr/trials/trials.h"
#include "table_units.h"

namespace awmr {

/// Returns the limit that the turns violate and the likely units of the yaw rates; empty if the
/// turns are possible. `surge`: surge runs of the same vehicle, if there are any.
std::optional<WrongUnit> wrong_turn(const TrialSet<TurningRow>& turning,
                                    const std::optional<TrialSet<SurgeRow>>& surge,
                                    const Vehicle& vehicle);

}  // namespace awmr
