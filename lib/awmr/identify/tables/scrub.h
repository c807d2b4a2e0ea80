/// The moment that differential turns need in addition to the resistance of steered turns. Private
/// to identify/.
///
/// A differential turn drags the tyres sideways, which g3 of steered turns does not include. Of
/// each such turn i, at r_i under tau_i = 2 d (F'R - F'L), the moment in addition to g3 is
///
///     c_i = tau_i - g3(r_i),    c = mean c_i,    var c = s^2/n + h' C h
///
/// with s the standard deviation of the c_i, C the covariance of the parameters of g3 and h the
/// mean gradient of g3 by them. The interval is Student's t with the degrees of freedom of Welch
/// and Satterthwaite.
#pragma once

#include <vector>

#include "awmr/model/model.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Smallest number of differential turns, from which a scatter can be estimated.
inline constexpr std::size_t kFewestScrubRows = 3;

/// Sets model.yaw_held_m, the largest moment at which the vehicle did not turn (`scrub-holds`), and
/// model.yaw_scrub if the model has g3 and there are enough turns (else `few-scrub-rows`) whose
/// interval is not all negative (else `negative-scrub`). Warns of turns beyond the yaw rates that
/// g3 was fitted to (`scrub-beyond-trials`) and of c_i that change with r (`scrub-grows`).
void measure_scrub(const TrialSet<TurningRow>& turning, Model& model);

}  // namespace awmr
