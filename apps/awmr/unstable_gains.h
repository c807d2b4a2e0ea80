/// Warning about gains with which a loop of the model is unstable.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "awmr/control/yaw_mode.h"
#include "awmr/model/gains.h"
#include "awmr/model/model.h"
#include "awmr/model/record.h"

namespace awmr::cli {

/// Adds the warning `unstable-gains` for each loop (heading, speed) of unstable_loops()
/// (tune/loop_stability.h). `gains_file`: name of the file in the warnings.
void note_unstable(const Model& model, const Gains<double>& gains,
                   const std::filesystem::path& gains_file, std::vector<Finding>& findings,
                   std::optional<YawMode> mode = {});

}  // namespace awmr::cli
