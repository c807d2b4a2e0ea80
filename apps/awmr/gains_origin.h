/// Check that gains were tuned on the model with which they are used.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/control/yaw_mode.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr::cli {

/// Adds the warning `gains-of-another-model` if the gains' file names its inputs and the model is
/// not one of them, by SHA-256. No finding for gains written by hand, which name no inputs, or from
/// a pipe, which can be read only once. Adds the warning `gains-of-another-mode` if they were tuned
/// for one mode only and are used in another. `mode`: the one in which they are used; absent: all.
/// Errors: as read_json_file.
Status note_other_model(const std::filesystem::path& gains, const std::filesystem::path& model,
                        std::vector<Finding>& findings, std::optional<YawMode> mode = {});

}  // namespace awmr::cli
