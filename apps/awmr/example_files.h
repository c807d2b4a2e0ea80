/// Files of `awmr init --example`: unmodified copies of the source's configs and datasets.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// Each file has its path in the source tree: "configs/paper/project.json".
const std::vector<EmbeddedFile>& example_files();

}  // namespace awmr
