/// Initial guess of the search for another resistance family. Private to identify/.
#pragma once

#include "awmr/model/family.h"
#include "awmr/model/resistance.h"

namespace awmr {

/// The curve of a family nearest to another: least squares over speeds spread evenly up to `fastest`,
/// in m/s or rad/s, > 0. A constant term that the family has, of Coulomb friction or of a dead zone, is
/// at least a tenth of the resistance at half of that: from 0 no search finds its way. It stands under
/// `coulomb` for both.
Resistance<double> nearest_curve(const Resistance<double>& curve, const FamilyTerms& terms,
                                 double fastest);

}  // namespace awmr
