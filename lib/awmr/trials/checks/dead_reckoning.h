/// Finds positions and headings that were integrated from the logged speed and yaw rate, as the
/// odometry of a wheeled robot is. Private to trials/.
#pragma once

#include <vector>

#include "awmr/trials/log.h"

namespace awmr {

/// Removes channels from `log` that only repeat others, and adds the finding `dead-reckoning`: the
/// heading, if it is the integral of the yaw rate, and the position, if the distance that it moves
/// is the integral of the speed. As measurements, they would count the same readings twice, and a
/// position that knows no sideslip would contradict the motion of the vehicle.
///
/// A pose is an integral if the difference D between its turns (distances) and the integral of the
/// yaw rate (speed) stays small:
///
///     rms(D - mean(D)) < 0.2 s sqrt(sum(h^2)/6)
///
/// with the steps h of the readings, s, and the standard deviation s of their noise. The right side
/// without 0.2 is the expected rms for a sensor of its own: the integral of independent errors is a
/// random walk. The integral uses the reading at the begin, at the end, or the mean of both, of
/// every step: whichever fits best.
void set_aside_dead_reckoning(DrivingLog& log, std::vector<Finding>& findings);

}  // namespace awmr
