/// Lists the files of a log that is given as a file or as a directory.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/result.h"

namespace awmr {

/// Returns `path` itself if it is a file. For a directory, returns its bags (`.db3`) if there are
/// any, else its tables (`.csv`), sorted by name. Errors (input): those of list_directory(); a
/// directory without bags and tables; an entry with one of these extensions that is not a regular
/// file.
Result<std::vector<std::filesystem::path>> files_of(const std::filesystem::path& path);

}  // namespace awmr
