/// Tyre scrub: the yaw moment that differential turns need in excess of the yaw resistance of
/// steered turns. Private to identify/.
///
/// A differential turn drags the tyres sideways. The yaw resistance g3 of steered turns does not
/// include the moment that this takes. For differential turn i, with the yaw rate r_i and half of
/// the track width d, the scrub moment is
///
///     c_i = tau_i - g3(r_i),   tau_i = 2 d (F'R - F'L),   c = mean c_i,   var c = s^2/n + h' C h
///
/// with s the standard deviation of the n moments c_i, and C the covariance of g3's parameters. h
/// is the gradient of g3(r_i) with respect to these parameters, averaged over the turns. The
/// interval uses Student's t with the effective degrees of freedom of Welch and Satterthwaite.
#pragma once

#include <vector>

#include "awmr/model/model.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Smallest number of differential turns for a scrub estimate with an interval.
inline constexpr std::size_t kMinScrubRows = 3;

/// Computes the scrub from the differential turns of the table. Does nothing without differential
/// turns or without g3. Sets model.yaw_held_m, the largest moment (over F_max, m) at which the
/// vehicle did not turn, with the finding `scrub-holds`. Sets model.yaw_scrub, unless there are too
/// few turns (`few-scrub-rows`) or the whole interval is negative (`negative-scrub`). Warns of
/// turns outside the yaw rates that g3 was fitted to (`scrub-beyond-trials`), and of moments c_i
/// that change with the yaw rate (`scrub-grows`).
void measure_scrub(const TrialSet<TurningRow>& turning, Model& model);

}  // namespace awmr
