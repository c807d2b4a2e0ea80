/// Detection of a gross outlier, which would dominate the fit. Private to identify/.
#pragma once

#include <cstddef>
#include <optional>

#include "awmr/identify/tables/family_choice.h"

namespace awmr {

struct GrossOutlier {
  std::size_t point = 0;    ///< index in the subject's points
  double deviations = 0.0;  ///< distance from the power law of the others, in standard deviations
};

/// The run farthest from the power law of the others, if two conditions hold. (1) Its distance is
/// more than ten standard deviations, and p < 0.001 by Student's t for the whole table; the time of a
/// timed run has to deviate as much, because the shortest times have the largest errors of their
/// logarithm. (2) No family fits all runs with a residual of less than three times that of the
/// others' power law: a low speed off a power law can be due to Coulomb friction.
std::optional<GrossOutlier> gross_outlier(const Subject& subject, const SubjectOptions& options);

/// `outlier`: the run is excluded.
Finding set_aside(const Subject& subject, const GrossOutlier& outlier);

}  // namespace awmr
