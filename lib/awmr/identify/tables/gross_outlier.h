/// Detection of a gross outlier: a run so far from the others that it would dominate the fit.
/// Private to identify/.
#pragma once

#include <cstddef>
#include <optional>

#include "awmr/identify/tables/family_choice.h"

namespace awmr {

struct GrossOutlier {
  std::size_t point = 0;    ///< index of the run in Subject::points
  double deviations = 0.0;  ///< from the power law of the other runs, in standard deviations
};

/// Returns the run farthest from the power law of the other runs if it is a gross outlier:
///   1. The run deviates by more than ten standard deviations, with p < 0.001 by Student's t for
///      the whole table. If the runs were timed, the time also deviates by more than ten, because
///      an equal error of all times is the largest in the logarithm of the shortest one.
///   2. No family fits all runs, this one included, with a residual below three times that of the
///      power law of the other runs. (A slow run can be off a power law by Coulomb friction.)
std::optional<GrossOutlier> gross_outlier(const Subject& subject, const SubjectOptions& options);

/// The finding `outlier`, which reports that the run is excluded from the fit.
Finding set_aside(const Subject& subject, const GrossOutlier& outlier);

}  // namespace awmr
