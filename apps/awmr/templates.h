/// Files that `awmr init` writes, embedded from the folder templates/.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// Returns the files, sorted by path. A line that begins with `@NAME ` is written only for that
/// kind of drive, without the mark: NAME is a drive (model/vehicle.h), or `steered` for drives with
/// steering.
const std::vector<EmbeddedFile>& project_templates();

}  // namespace awmr
