/// Warnings about gains that were tuned for another model or mode.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/control/yaw_mode.h"
#include "awmr/core/result.h"
#include "awmr/model/record.h"

namespace awmr::cli {

/// Adds a warning if the gains were tuned for another model or another mode, or were changed after
/// tuning (`gains-changed`).
/// `gains-of-another-model`: the gains file lists inputs, but the SHA-256 of the model is not among
/// them. `gains-of-another-mode`: the gains were tuned for one mode only, and are used in another.
/// `mode`: the mode in which the gains are used; absent: all modes. No warning for gains that were
/// written by hand (they list no inputs), or that come from a pipe (it can be read only once).
/// Errors: those of read_json_file().
Status note_other_model(const std::filesystem::path& gains, const std::filesystem::path& model,
                        std::vector<Finding>& findings, std::optional<YawMode> mode = {});

}  // namespace awmr::cli
