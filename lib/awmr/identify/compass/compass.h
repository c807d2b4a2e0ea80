/// Hard and soft iron of a compass from a record of its field over whole turns.
#pragma once

#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/compass.h"
#include "awmr/model/record.h"
#include "awmr/trials/field.h"

namespace awmr {

struct CompassFit {
  CompassCalibration calibration;
  std::vector<Finding> findings = {};
};

/// Fits the ellipse with the least squares of the distances, divided by its size. Intervals allow
/// for residuals that are correlated within 10 degrees of the turn. Findings: `compass-residual`
/// (the field is no ellipse within 5 %), `turn-not-checked` (no yaw rate). Errors (refused): the
/// turn leaves more than 30 degrees out; the field is no ellipse; compass and gyroscope turn by
/// amounts that are more than 10 % apart, or against each other.
Result<CompassFit> fit_compass(const FieldRecord& record, double declination_deg);

}  // namespace awmr
