/// The files that a trial is read from.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

/// The path itself, or of a directory the files in it that are joined into one log, by name: the
/// bags (`.db3`) where there are some, else the tables (`.csv`). Errors: a directory without either.
Result<std::vector<std::filesystem::path>> files_of(const std::filesystem::path& path);

}  // namespace awmr
