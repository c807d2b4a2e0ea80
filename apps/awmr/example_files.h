/// Files that `awmr init --example` writes: unmodified copies of the configs and datasets in the
/// source tree.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// Returns the files. The path of each is that in the source tree: "configs/paper/project.json".
const std::vector<EmbeddedFile>& example_files();

}  // namespace awmr
