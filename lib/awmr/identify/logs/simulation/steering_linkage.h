/// Errors of the steering linkage in a log fit (FreeQuantity::is_of_linkage()): the limit of the
/// angle at the stop, and the unknown scale of the angles. Private to identify/.
///
/// A vehicle file gives one steering stop d_max, but does not say whether this stop limits the
/// angle of the wheels or the command. L(c) is the angle to which the linkage steers at the command
/// c. The wheels point to
///
///     sat(L(c), d_max)     if the stop limits the angle: a mechanical stop at the wheels
///     L(sat(c, d_max))     if the stop limits the command: the servo or the program clips it
///
/// In the second case, the angle may lie beyond d_max.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/logs/choice/family_fit.h"
#include "awmr/identify/logs/problem/noise_iteration.h"

namespace awmr {

/// True if the fit has an error of the linkage, and commands of the logs would steer the wheels
/// beyond the stop if nothing limited them.
bool is_stop_reached(const LogProblem& problem, const SearchPoint& point);

/// Fits the logs with the second meaning of the steering stop: if the stop limits the steering
/// angle in `settled`, it limits the steering command in this fit, and the reverse. Empty if the
/// AIC of this fit is not lower, or if is_stop_reached() is false.
std::optional<NoiseIteration> with_other_stop(const NoiseIteration& settled);

/// Compares the two meanings of the stop for the converged fit `chosen`. The fit with the lower AIC
/// becomes `chosen`. If the AIC of the other fit is higher by less than 10, the logs do not decide.
/// The intervals of the parameters that differ between the fits by more than one standard error are
/// then withdrawn, and the finding `steering-stop` names these parameters. Empty if nothing was
/// withdrawn.
std::optional<Finding> decide_stop(const std::vector<DrivingLog>& logs, FamilyFit& chosen);

/// Widens the intervals of the fit `chosen` because the scale s of the steering angles is unknown.
/// Only for fits with an asymmetry e or a curve k of the linkage that do not estimate the scale.
///
/// With forces that are equal left and right, angles of s times the assumed ones have nearly the
/// same effect as I'z, yaw and sway resistance divided by s. A fit with e assumes that the scale is
/// right for the mean of left and right, a fit with k that it is right for small commands. In fact,
/// the scale may be right on one side, or at the stop. The prior standard deviation of ln s is
/// therefore
///
///     sqrt(e^2 + ln(1 + k)^2)
///
/// This function fits the logs once more with angles of this scale. The changes Delta of the
/// coordinates add
///
///     Delta Delta^T/(1 + D),   D: increase of -2 ln L by this scale, at least 0
///
/// to the covariance, because the logs reduce the variance of ln s by the factor 1/(1 + D).
void widen_by_steering_scale(const std::vector<DrivingLog>& logs, FamilyFit& chosen);

/// True if the fit has a curve of the linkage of more than 5 %. The yaw resistance then gets no
/// intervals: its form follows from the steering angles, and the true form of the curve is unknown.
bool is_much_curved(const LogFit& fit);

}  // namespace awmr
