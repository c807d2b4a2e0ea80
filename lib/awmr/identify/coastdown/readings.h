/// Selects the rows of coast-down curves that are new measurements of the speed. Private to
/// identify/.
#pragma once

#include <vector>

#include "awmr/model/record.h"
#include "awmr/trials/trials.h"

namespace awmr {

inline constexpr std::size_t kFewestRows = 3;  ///< smallest number of rows of a curve that is used

/// Coast-down curves after measured_rows() has removed the rows that are not measurements.
struct CoastReadings {
  std::vector<CoastCurve> curves;
  double quantum_mps = 0.0;  ///< resolution of a coarse sensor; 0: not detected
};

/// Removes rows that are not measurements:
///   - the rows at rest. They begin at the first speed of exactly 0 from which on at least half of
///     the rows are 0. An encoder reads 0 at rest and also below its lowest speed, so these rows do
///     not show when the vehicle stopped. If the speed before, extrapolated to the first of these
///     rows, is significantly above 0, adds the finding `speed-cut-off`;
///   - repeated values of a sensor that is slower than the rows (find_repeats(); `held-samples`).
/// Speed bins stay as they are.
CoastReadings measured_rows(const std::vector<CoastCurve>& curves, std::vector<Finding>& findings);

/// Standard deviation of a curve's speed noise, estimated from the distance e_i of each speed u_i
/// from the line through its neighbours in time:
///
///     e_i = u_i - (1 - w) u_(i-1) - w u_(i+1),   w = (t_i - t_(i-1))/(t_(i+1) - t_(i-1))
///     std^2 = mean of e_i^2/(1 + w^2 + (1 - w)^2)
///
/// Precondition: three rows.
double noise_of(const CoastCurve& curve);

}  // namespace awmr
