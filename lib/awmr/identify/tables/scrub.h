/// The moment that differential turns need in addition to the resistance of steered turns. Private
/// to identify/.
///
/// A differential turn drags the tyres sideways, which g3 of steered turns does not include. Of
/// each such turn i, at r_i under tau_i = 2 d (F'R - F'L), the moment in addition to g3 is
///
///     c_i = tau_i - g3(r_i),    c = mean c_i,    var c = s^2/n + h' C h
///
/// with s the scatter of the c_i, C the covariance of g3 and h the mean gradient of g3 by what it has.
/// The interval is Student's t with the degrees of freedom of Welch and Satterthwaite.
#pragma once

#include <vector>

#include "awmr/model/model.h"
#include "awmr/trials/trials.h"

namespace awmr {

/// Fewer differential turns give no estimate of scatter.
inline constexpr std::size_t kFewestScrubRows = 3;

/// Sets model.yaw_scrub where the model knows g3 and there are enough turns, which then have to lie
/// within the yaw rates that g3 was fitted to. Findings say why not (`few-scrub-rows`, `negative-scrub`,
/// `scrub-beyond-trials`), and where c_i changes with r (`scrub-grows`), which a constant does not tell.
void measure_scrub(const TrialSet<TurningRow>& turning, Model& model);

}  // namespace awmr
