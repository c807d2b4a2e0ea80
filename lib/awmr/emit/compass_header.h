/// Makes awmr_compass.h, a header with the calibration of a compass for the emitted sketches.
#pragma once

#include <string>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/compass.h"

namespace awmr {

/// Text of awmr_compass.h, which belongs into src/ of the library. `record`: the file with the
/// recorded magnetic field, for its name and hash. Errors (input): a constant is neither 0 nor a
/// normal float32.
Result<std::string> compass_header(const CompassCalibration& calibration, const InputFile& record);

}  // namespace awmr
