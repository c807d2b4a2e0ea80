/// What `awmr init` writes, as it was built in from templates/.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// In the order of their paths. A line that begins with `@NAME ` is for the drive of that name alone
/// (model/vehicle.h), without this mark.
const std::vector<EmbeddedFile>& project_templates();

}  // namespace awmr
