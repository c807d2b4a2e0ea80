/// Readings that are means: a program divides a distance or an angle, for example counts of
/// encoders, by a time. Private to identify/.
#pragma once

#include <cstddef>

#include "awmr/identify/logs/simulation/command_path.h"
#include "awmr/identify/logs/simulation/linear_stepper.h"

namespace awmr {

/// Time L over which a reading is averaged, s; at least 0.1 ms, because L = 0 has no mean.
double averaging_time_s(const TermColumn& averaging);

/// Returns the motion `end` with the mean speed and the mean yaw rate of the last L seconds in
/// place of u and r. `begin`: the motion L seconds before `end`; `averaging`: L and its column;
/// `columns`: number of columns of the fit. The motion from (x, y, psi) to (x', y', psi') turns by
/// a = psi' - psi. With the mean heading p = (psi + psi')/2,
///
///     r_mean = a/L
///     u_mean = (a/2)/sin(a/2) (((x' - x) cos p + (y' - y) sin p)/L - (v r' - v' r) L/12)
///
/// The first factor is the ratio of arc and chord. Its series 1 + (a/2)^2/6 + 7 (a/2)^4/360 is
/// used, which is accurate within 0.2 % for |a| < 2 rad. (L is at most 0.2 s.) The last term is the
/// mean of v times the angle to p, if v and r change at constant rates.
LinearMotion averaged_motion(const LinearMotion& begin, LinearMotion end,
                             const TermColumn& averaging, std::size_t columns);

}  // namespace awmr
