/// Scale error of the gyroscope that a heading or positions leave open. Private to identify/.
#pragma once

#include <optional>
#include <vector>

#include "awmr/identify/logs/family_fit.h"

namespace awmr {

/// Prior standard deviation of the scale error s of a gyroscope (it reads 1 + s times the true yaw
/// rate). Data sheets of uncalibrated MEMS gyroscopes give tolerances from 0.5 % (ICM-42688-P) and
/// 1.5 % (ICM-20948) to 3 % (MPU-6050).
inline constexpr double kGyroScaleStd = 0.01;

/// If the logs have a yaw rate and a heading or positions, but the fit does not estimate the scale
/// error s of the yaw rate, adds the effect of s to the covariance and the intervals of `chosen`. s
/// has a normal prior with the mean 0 and the standard deviation kGyroScaleStd. With the
/// information h about s in the logs and the value s_1 that they indicate (both from one
/// Gauss-Newton step), the mean and the variance of s are
///
///     m = s_1 h/(h + 1/kGyroScaleStd^2),   var = 1/(h + 1/kGyroScaleStd^2)
///
/// The fit assumes s = 0, so the variance that counts is var + m^2. Returns the note
/// `gyro-scale-open` if a standard error grows by half or more and the standard deviation of s is
/// above a quarter of kGyroScaleStd, else empty.
std::optional<Finding> widen_by_gyro_scale(const std::vector<DrivingLog>& logs, FamilyFit& chosen);

}  // namespace awmr
