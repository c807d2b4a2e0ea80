/// Initial guess of the search for another resistance family. Private to identify/.
#pragma once

#include "awmr/model/family.h"
#include "awmr/model/resistance.h"

namespace awmr {

/// Returns the curve of a family nearest to another curve, by least squares at equidistant speeds
/// up to `fastest`, in m/s or rad/s, > 0. A constant term of the family (Coulomb friction or dead
/// zone) is at least a tenth of the resistance at half of `fastest`, because a search cannot leave
/// 0. Both are returned as `coulomb`.
Resistance<double> nearest_curve(const Resistance<double>& curve, const FamilyTerms& terms,
                                 double fastest);

}  // namespace awmr
