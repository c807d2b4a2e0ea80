/// Initial guess for fitting another resistance family (form of the resistance law) to logs.
/// Private to identify/.
#pragma once

#include "awmr/model/family.h"
#include "awmr/model/resistance.h"

namespace awmr {

/// Returns the resistance curve of another family that is nearest to `curve`. `terms`: free terms
/// of that family. The distance is the sum of squares at equidistant speeds up to `fastest` (m/s or
/// rad/s, > 0).
///
/// The member `coulomb` of the result is the constant term: Coulomb friction, or the force that a
/// dead zone takes. It is at least a tenth of the resistance at half of `fastest`, because a fit of
/// logs that starts at 0 could stay there even if 0 is wrong. Returns `curve` itself if no such
/// curve exists.
Resistance<double> nearest_curve(const Resistance<double>& curve, const FamilyTerms& terms,
                                 double fastest);

}  // namespace awmr
