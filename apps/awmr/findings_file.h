/// The page FINDINGS.md, embedded in the program. It has the meaning and the remedy of each finding
/// code.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// Returns a list whose only file is FINDINGS.md.
const std::vector<EmbeddedFile>& findings_file();

}  // namespace awmr
