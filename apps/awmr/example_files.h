/// The files of `awmr init --example`: the source's configs and datasets, as they are.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// Each under its path in the source: "configs/paper/project.json".
const std::vector<EmbeddedFile>& example_files();

}  // namespace awmr
