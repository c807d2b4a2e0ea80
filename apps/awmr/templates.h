/// Files that `awmr init` writes, embedded from the folder templates/.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// Returns the files, sorted by path. A line of a file may begin with the mark `@NAME `. Such a
/// line is written, without the mark, only for that kind of drive: NAME is a drive
/// (model/vehicle.h), or `steered` for all drives with steering.
const std::vector<EmbeddedFile>& project_templates();

}  // namespace awmr
