/// Files of a trial.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

/// Returns the path itself, or for a directory its files sorted by name, which are joined into one
/// log: the bags (`.db3`) if there are any, else the tables (`.csv`). Errors: a directory without
/// either.
Result<std::vector<std::filesystem::path>> files_of(const std::filesystem::path& path);

}  // namespace awmr
