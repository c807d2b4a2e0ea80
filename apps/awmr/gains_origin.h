/// Whether gains were tuned on the model that they are used with.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr::cli {

/// Adds a warning (`gains-of-another-model`) where the gains' file names the inputs that it was made
/// from and the model is none of them, by SHA-256. Gains written by hand name no inputs and give no
/// finding, nor do those of a pipe, which can be read only once. Errors: as read_json_file.
Status note_other_model(const std::filesystem::path& gains, const std::filesystem::path& model,
                        std::vector<Finding>& findings);

}  // namespace awmr::cli
