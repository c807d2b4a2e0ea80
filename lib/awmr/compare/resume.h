/// A comparison that was stopped, read back.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/compare/compare.h"
#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr {

/// The rows of a comparison.csv written before, and a check that its comparison.json is of the same
/// inputs and options; the numbers of samples and threads may differ. Errors (input): the files
/// are missing, malformed, of another comparison or of another version of the program.
Result<std::vector<ComparisonRow>> read_finished(const std::filesystem::path& directory,
                                                 const Provenance& provenance);

}  // namespace awmr
