/// Warnings about gains that are used with another model or mode than they were tuned for, or that
/// are unstable at the model's sample time.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/control/yaw_mode.h"
#include "awmr/core/result.h"
#include "awmr/model/gains.h"
#include "awmr/model/record.h"

namespace awmr::cli {

/// Adds a warning if the gains were tuned for another model or another mode.
/// `gains-of-another-model`: the gains file lists the SHA-256 of its inputs, and that of the model
/// is not among them. `gains-of-another-mode`: the gains were tuned for one mode and are used in
/// another. `mode`: the mode in which they are used; absent: all modes. No warning for gains that
/// were written by hand, because they list no inputs, and for gains from a pipe, which can be read
/// only once. Errors: those of read_json_file().
Status note_other_model(const std::filesystem::path& gains, const std::filesystem::path& model,
                        std::vector<Finding>& findings, std::optional<YawMode> mode = {});

/// Adds the warning `unstable-gains` for each loop (heading, speed) that is unstable at this sample
/// time with any vehicle. `gains_file`: the file that the warnings name.
void note_unstable(const Gains<double>& gains, double sample_time_s,
                   const std::filesystem::path& gains_file, std::vector<Finding>& findings);

}  // namespace awmr::cli
