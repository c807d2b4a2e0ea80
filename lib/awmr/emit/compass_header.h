/// The constants of a compass for the emitted sketches.
#pragma once

#include <string>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/compass.h"

namespace awmr {

/// The bytes of awmr_compass.h, which the sketches take from the library's src/; `record` is the
/// file that the calibration was made from. Errors (input): a constant is no normal float32 or 0.
Result<std::string> compass_header(const CompassCalibration& calibration, const InputFile& record);

}  // namespace awmr
