/// Check that gains were tuned on the model with which they are used.
#pragma once

#include <filesystem>
#include <vector>

#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr::cli {

/// Adds a warning (`gains-of-another-model`) if the gains file lists its inputs by SHA-256 and the
/// model is not among them. Gains written by hand list no inputs and give no finding. Neither do
/// gains from a pipe, which can be read only once. Errors: as read_json_file.
Status note_other_model(const std::filesystem::path& gains, const std::filesystem::path& model,
                        std::vector<Finding>& findings);

}  // namespace awmr::cli
