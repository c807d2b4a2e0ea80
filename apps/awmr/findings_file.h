/// FINDINGS.md, embedded: what each finding code means and what to do.
#pragma once

#include <vector>

#include "awmr/core/embedded_file.h"

namespace awmr {

/// One file.
const std::vector<EmbeddedFile>& findings_file();

}  // namespace awmr
