/// Files of the emitted library that do not depend on the model, compiled into the program. Private
/// to emit/.
#pragma once

#include <vector>

#include "awmr/core/files/embedded_file.h"

namespace awmr {

/// Returns the headers of lib/awmr (src/awmr/), sorted by path; then the files of assets/, sorted
/// by path; then LICENSE.
const std::vector<EmbeddedFile>& embedded_files();

}  // namespace awmr
