/// Output files of `run`: lists their names, checks that no file of another program would be
/// overwritten, and writes the simulated runs that the report shows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "inputs.h"
#include "project.h"

namespace awmr::cli {

/// Subdirectory of the output directory for the Arduino library.
inline constexpr const char* kLibrary = "firmware";

/// Returns the names of the files that `run` writes directly into its output directory. Files in
/// the subdirectories `firmware` and `figures` are not among them.
std::vector<std::string> run_outputs(const Project& project);

/// Checks that `run` may overwrite the files in the directory. Errors (input): each file that awmr
/// did not write. The check recognises a result of awmr by the command that it names, and an
/// emitted file by the manifest.
Status check_own_results(const std::filesystem::path& directory);

/// Simulates every scenario of the project in every mode, once with the tuned gains and once with
/// the paper's gains. Reads model.json and gains.json from `directory`. Writes there the scenarios,
/// the runs, and for each run a file with its origin (.csv.json). Returns the paths of the written
/// files.
Result<std::vector<std::filesystem::path>> write_runs(const Project& project,
                                                      const InputNames& names,
                                                      const std::filesystem::path& directory);

}  // namespace awmr::cli
