/// The files of the emitted library that do not depend on the model, as they were built in.
/// Private to emit/.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// In the order of their paths within each part.
const std::vector<EmbeddedFile>& embedded_files();

}  // namespace awmr
