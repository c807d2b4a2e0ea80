/// Writes the calibration constants of a compass as a header for the emitted sketches.
#pragma once

#include <string>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"
#include "awmr/model/compass.h"

namespace awmr {

/// Text of awmr_compass.h, which the sketches include from the library's src/; `record` is the file
/// of the calibration data. Errors (input): a constant is neither a normal float32 nor 0.
Result<std::string> compass_header(const CompassCalibration& calibration, const InputFile& record);

}  // namespace awmr
