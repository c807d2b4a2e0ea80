/// Check that gains were tuned on the model with which they are used.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/control/yaw_mode.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr::cli {

/// Adds a warning (`gains-of-another-model`) where the gains' file names the inputs that it was made
/// from and the model is none of them, by SHA-256. Gains written by hand name no inputs and give no
/// finding, nor do those of a pipe, which can be read only once. Another (`gains-of-another-mode`) where they
/// were tuned for one mode alone and are used in another; `mode`: in which, absent: in all. Errors: as
/// read_json_file.
Status note_other_model(const std::filesystem::path& gains, const std::filesystem::path& model,
                        std::vector<Finding>& findings, std::optional<YawMode> mode = {});

}  // namespace awmr::cli
