/// Warning about gains with which a loop of the model is unstable.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "awmr/model/mode_gains.h"
#include "awmr/model/model.h"
#include "awmr/model/record.h"
#include "awmr/simulate/scenario.h"

namespace awmr::cli {

/// Adds the warning `unstable-gains` for each loop (heading, speed) that unstable_loops()
/// (tune/loop_stability.h) finds. Uses the latency and the motor lag of vehicle.json. `gains_file`:
/// name of the file in the warnings.
void note_unstable(const Model& model, const ModeGains& gains,
                   const std::filesystem::path& gains_file, std::vector<Finding>& findings);

/// The same with the latency and the motor lag of the closed-loop scenarios, after equipped()
/// (simulate/conditions.h). Of several scenarios with unstable loops, only the first is reported.
void note_unstable(const Model& model, const ModeGains& gains,
                   const std::filesystem::path& gains_file, std::span<const Scenario> scenarios,
                   std::vector<Finding>& findings, std::optional<YawMode> mode = {});

}  // namespace awmr::cli
