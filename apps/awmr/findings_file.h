/// FINDINGS.md, embedded: meaning and remedy of each finding code.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// Returns a list with FINDINGS.md as its only file.
const std::vector<EmbeddedFile>& findings_file();

}  // namespace awmr
