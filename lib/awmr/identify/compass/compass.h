/// Calibration of a compass for hard and soft iron (magnets and iron on the vehicle). Input: the
/// field that the compass measured while the vehicle turned through whole circles.
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

/// Fits an ellipse to the measured field by least squares of the distances from the ellipse,
/// relative to its size. The intervals are valid also if residuals within 10 degrees of the turn
/// are correlated. Findings: `compass-residual` (standard deviation of the residuals above 5 % of
/// the field), `turn-not-checked` (the record has no yaw rate). Errors (refused): a gap without
/// readings of more than 30 degrees in the circle; no ellipse, or residuals above 20 %; a centre or
/// axes that the firmware cannot use; turn angles of compass and gyroscope that differ by more than
/// 10 % or in sign. `declination_deg`: magnetic declination of the place, east positive, stored in
/// the calibration.
Result<CompassFit> fit_compass(const FieldRecord& record, double declination_deg);

}  // namespace awmr
