/// A run so far off that it would take the fit. Private to identify/.
#pragma once

#include <cstddef>
#include <optional>

#include "awmr/identify/tables/family_choice.h"

namespace awmr {

struct GrossOutlier {
  std::size_t point = 0;    ///< of the subject's points
  double deviations = 0.0;  ///< from the power law of the others, in their standard deviations
};

/// The run farthest off the power law of the others, where it lies more than ten of their standard
/// deviations off (by Student's t less likely than 1 in 1,000 for the whole table), and no family
/// describes all runs even a third as closely as the power law describes the others. Timed runs have
/// to lie as far off in their time: the shortest have the largest errors of their logarithm. None
/// otherwise: a low speed off a power law may be Coulomb friction.
std::optional<GrossOutlier> gross_outlier(const Subject& subject, const SubjectOptions& options);

/// `outlier`: the run is set aside.
Finding set_aside(const Subject& subject, const GrossOutlier& outlier);

}  // namespace awmr
