/// Detection of a gross outlier: a run so far from the curve of all other runs that it would
/// dominate the fit. Private to identify/.
#pragma once

#include <cstddef>
#include <optional>

#include "awmr/identify/tables/table_family.h"

namespace awmr {

struct GrossOutlier {
  std::size_t point = 0;  ///< index of the run in Subject::points
  /// Deviation of ln f from the power law of the other runs, in standard deviations; > 0.
  double deviations = 0.0;
};

/// Returns the run farthest from the power law of the other runs if it is a gross outlier:
///   1. The logarithm of its force deviates by more than ten standard deviations, and such a run in
///      the whole table has a probability below 0.001 (Student's t, Bonferroni). If the runs were
///      timed, its time also deviates by more than ten standard deviations from a fit of the other
///      times. (A timing error of a given size is a larger share of a short time, so the force
///      alone would exclude some correct fast runs.)
///   2. The deviation is not due to the power law: for every resistance family fitted to all runs,
///      including this one, the root mean square residual of ln f is at least three times that of
///      the power law of the other runs. (A slow run can deviate from a power law because of
///      Coulomb friction.)
/// Empty if there is no such run or the runs are too few for the test.
std::optional<GrossOutlier> gross_outlier(const Subject& subject, const SubjectOptions& options);

/// The finding `outlier`, which reports that the run is excluded from the fit.
Finding set_aside(const Subject& subject, const GrossOutlier& outlier);

}  // namespace awmr
