/// Files that `awmr init` writes, embedded from templates/.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// Sorted by path. A line that begins with `@NAME ` applies only to the drive of that name
/// (model/vehicle.h); the mark itself is removed.
const std::vector<EmbeddedFile>& project_templates();

}  // namespace awmr
