/// Output files of `run`: lists their names, checks that `run` would not overwrite files that awmr
/// did not write, and writes the simulated runs for the report.
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

/// Names of all files that `run` writes directly into its output directory; those in its
/// subdirectories `firmware` and `figures` are not listed.
std::vector<std::string> run_outputs(const Project& project);

/// Checks that the files in the directory may be overwritten. Errors (input): each file that `run`
/// would overwrite and that no awmr command wrote. A result of awmr names its command; an emitted
/// file is in the manifest.
Status check_own_results(const std::filesystem::path& directory);

/// Simulates every scenario of the project in every mode, with the tuned gains and with the paper's
/// gains. Writes the scenarios, the runs and their side files (.csv.json, with the origin of a run)
/// into the directory, from which it reads model.json and gains.json. Returns the paths of the
/// written files.
Result<std::vector<std::filesystem::path>> write_runs(const Project& project,
                                                      const InputNames& names,
                                                      const std::filesystem::path& directory);

}  // namespace awmr::cli
