/// Calibration checks of a driving log. They detect errors of scale and direction that are too
/// small to be a wrong unit, for example a wrong wheel radius or a compass that is rotated in the
/// vehicle.
///
/// The log is divided into windows [t0, t1] of a twentieth of its length (1 to 5 s). In each window
/// the check compares the displacement of the position p = x + i y with the integral of the speed u
/// along the heading psi. It fits the complex factors k, k_b, k_c and k_d to all windows. The terms
/// with k_b, k_c and k_d absorb effects that would otherwise look like an error of k. With the yaw
/// rate r,
///
///     p(t1) - p(t0) = k a + k_b b + k_c c + k_d d,   k = s exp(i phi)
///     a = int u exp(i psi) dt                displacement by speed and heading
///     b = int r exp(i psi) dt                an antenna off the centre of gravity
///     c = int u r exp(i psi) dt              sideslip in turns, latency of the heading
///     d = int exp(i psi) du                  latency of speed or position
///
/// s is the ratio of the position's scale to the speed's scale (1 if both are right). phi is the
/// angle from the heading to the course over ground (the direction of motion).
///
/// Values between the readings of a slow sensor are interpolated (with_interpolated_values()).
///
/// In a log without a heading, psi is the integral of the yaw rate. Its unknown initial value does
/// not change the length of a displacement, so the check then compares only lengths. The factors of
/// c and d are then i k_c and k_d, with k_c and k_d real: sideslip acts across the heading, latency
/// of the speed along it. The check neglects the squares of these two terms. The constant n is due
/// to noise of the positions; * marks the complex conjugate:
///
///     |p(t1) - p(t0)|^2 = s^2 |a|^2 + 2 s Re(k_b* a b*) + |k_b|^2 |b|^2 + 2 s k_c Im(a c*)
///                         + 2 s k_d Re(a d*) + n
///
/// A second check compares the change of heading with the integral of the yaw rate. Here k is the
/// ratio of the heading's scale to the yaw rate's scale, k_0 corrects an offset of the yaw rate,
/// and k_1 is the latency between heading and yaw rate:
///
///     psi(t1) - psi(t0) = k int r dt + k_0 (t1 - t0) + k_1 (r(t1) - r(t0))
///
/// Heading and yaw rate can agree although both have the same wrong scale, for example from wheel
/// odometry with a wrong track width. The angle from a to the displacement then grows with the
/// heading. In this equation, k is the ratio of the change of course to the change of heading
/// (windows of a sixtieth of the log, 1 to 5 s):
///
///     arg((p(t1) - p(t0))/a) = phi + (k - 1) (psi(t0) + psi(t1))/2
///                              + k_2 (psi(t1) - psi(t0)) + k_3 t0
///
/// k_2 is due to sideslip and latency of the heading in turns, k_3 to a drift of the heading.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "awmr/trials/log.h"
#include "awmr/trials/read_trials.h"

namespace awmr {

/// Estimate of a scale ratio (dimensionless), of an angle (rad) or of an angular rate (rad/s), with
/// its standard error.
struct Calibration {
  double value = 0.0;
  double std_error = 0.0;
};

/// Angle phi from the heading to the course over ground, rad, left positive. Empty if its magnitude
/// is below 1 deg or below five standard errors. Empty also if x, y, the heading or the speed was
/// not measured, or if the log has fewer than 15 windows.
std::optional<Calibration> heading_offset_rad(const DrivingLog& log);

/// Bias of the yaw rate: measured yaw rate minus rate of change of the heading, rad/s; the median
/// over windows of one second. Empty if its magnitude is below five standard errors. Empty also if
/// heading or yaw rate was not measured, or with fewer than 10 windows.
std::optional<Calibration> gyro_bias_radps(const DrivingLog& measured);

/// Returns the warnings `heading-offset` (heading_offset_rad() is not empty) and `scale-mismatch`
/// (the scales of two channels differ by more than 3 % and by more than five standard errors). If
/// heading and yaw rate differ, `scale-mismatch` names the channel that disagrees with the
/// positions, or both channels if the positions do not decide. The finding also names both channels
/// if heading and yaw rate agree with each other, but not with the positions. `mappings`: column
/// mappings used to read the log.
std::vector<Finding> calibration_findings(const DrivingLog& measured,
                                          std::span<const ColumnMapping> mappings);

}  // namespace awmr
