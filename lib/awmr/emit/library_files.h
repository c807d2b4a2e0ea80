/// Files of the emitted library that do not depend on the model, compiled into the program. Private
/// to emit/.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// Sorted by path within each part.
const std::vector<EmbeddedFile>& embedded_files();

}  // namespace awmr
