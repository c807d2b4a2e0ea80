/// Checks the units of heading, yaw rate, position and speed in a log. Private to this folder.
#pragma once

#include <vector>

#include "awmr/trials/log_evidence.h"

namespace awmr {

/// Compares yaw rate with heading, and speed with positions. Without a heading or without
/// positions, detects yaw rates and speeds that no wheeled vehicle reaches.
std::vector<Contradiction> motion_unit_contradictions(const Evidence& evidence);

}  // namespace awmr
