/// Output files of `run`: writes the simulated runs that the report shows, lists all files, and
/// checks that no file of another program is overwritten.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "awmr/core/result.h"
#include "inputs.h"
#include "project.h"

namespace awmr::cli {

/// Directory of the Arduino library in the output directory.
inline constexpr const char* kLibrary = "firmware";

/// Names of all files that `run` writes directly into its output directory.
std::vector<std::string> run_outputs(const Project& project);

/// Errors (input): each file that `run` would overwrite and that no awmr command wrote. Results name
/// their command; emitted files are listed in their manifest.
Status check_own_results(const std::filesystem::path& directory);

/// Writes every scenario, and its runs in every mode with the tuned and with the paper's gains.
/// Reads model.json and gains.json from the directory. Returns the paths.
Result<std::vector<std::filesystem::path>> write_runs(const Project& project,
                                                      const InputNames& names,
                                                      const std::filesystem::path& directory);

}  // namespace awmr::cli
