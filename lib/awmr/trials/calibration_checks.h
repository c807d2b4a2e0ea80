/// Calibration checks of a log: small differences of scale and direction between channels, which no
/// wrong unit causes.
///
/// In windows of a twentieth of the log (1 to 5 s), the displacement is compared with the integral
/// of speed and heading, in the complex plane:
///
///     p(t1) - p(t0) = k a + k_b b + k_c c + k_d d,   k = s exp(i phi)
///     a = int u exp(i psi) dt
///     b = int r exp(i psi) dt                an antenna off the centre of gravity
///     c = int u r exp(i psi) dt              sideslip in turns, latency of the heading
///     d = int exp(i psi) du                  latency of speed or position
///
/// s is the ratio of the scales of position and speed, phi the angle from the heading to the course
/// over ground. The change of the heading is compared with the integral of the yaw rate, with a
/// bias and a latency between them:
///
///     psi(t1) - psi(t0) = k int r dt + k_0 (t1 - t0) + k_1 (r(t1) - r(t0))
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "awmr/trials/log.h"
#include "awmr/trials/read_trials.h"

namespace awmr {

/// A number with its standard error.
struct Calibration {
  double value = 0.0;
  double std_error = 0.0;
};

/// Angle from the heading to the course over ground, rad, if it exceeds 1 deg and five standard
/// errors. Absent if a position, the heading or the speed was not measured.
std::optional<Calibration> heading_offset_rad(const DrivingLog& log);

/// `heading-offset` and `scale-mismatch` (warnings): scales that differ by more than 3 % and five
/// standard errors, with the faulty channel if a third one identifies it, else with both.
/// `mappings`: those that the log was read with.
std::vector<Finding> calibration_findings(const DrivingLog& log,
                                          std::span<const ColumnMapping> mappings);

}  // namespace awmr
