/// Whether the channels of a log agree in scale and direction, as far as calibration goes: errors that no
/// wrong unit makes.
///
/// Over windows of a twentieth of the log, 1 to 5 s, displacement against what speed and heading add up to, in the complex plane:
///
///     p(t1) - p(t0) = k a + k_b b + k_c c + k_d d,   k = s exp(i phi)
///     a = int u exp(i psi) dt
///     b = int r exp(i psi) dt                an antenna off the centre of gravity
///     c = int u r exp(i psi) dt              side slip in turns, a late heading
///     d = int exp(i psi) du                  a late speed or position
///
/// s is the positions' scale over the speed's, phi the course over ground from the heading. And the turn
/// of the heading against the yaw rate, with a bias and the time between the two:
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

/// The course over ground from the heading, rad, where it is off by more than a degree and five standard
/// errors; none where a position, the heading or the speed was not measured.
std::optional<Calibration> heading_offset_rad(const DrivingLog& log);

/// `heading-offset` and `scale-mismatch` (warnings): scales that differ by more than 3 % and five
/// standard errors, with the channel at fault if a third one shows it, else with both. `mappings`:
/// those that the log was read with.
std::vector<Finding> calibration_findings(const DrivingLog& log,
                                          std::span<const ColumnMapping> mappings);

}  // namespace awmr
