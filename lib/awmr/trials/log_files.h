/// Lists the files of a log that is given as a file or as a directory; hashes the input files of an
/// output.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "awmr/core/provenance.h"
#include "awmr/core/result.h"

namespace awmr {

/// Returns `path` itself if it is a file. For a directory, returns its bags (`.db3`) if there are
/// any, else its tables (`.csv`), sorted by name. Errors (input): those of list_directory(); a
/// directory without bags and tables; an entry with one of these extensions that is not a regular
/// file.
Result<std::vector<std::filesystem::path>> files_of(const std::filesystem::path& path);

/// Names under which output files list their input files. The key is the path of an input file.
using InputNames = std::map<std::filesystem::path, std::string>;

/// Returns name and SHA-256 of each file, in the order of `paths`. A directory in `paths` means all
/// log files in it. A file that is not in `names` gets its file name without directory. Errors:
/// those of input_file() and files_of() for the first file that fails.
Result<std::vector<InputFile>> input_files(const std::vector<std::filesystem::path>& paths,
                                           const InputNames& names = {});

}  // namespace awmr
