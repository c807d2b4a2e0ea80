/// Checks the units of heading, yaw rate, position and speed in a log. Private to this folder.
#pragma once

#include <vector>

#include "awmr/trials/log_evidence.h"

namespace awmr {

/// Compares yaw rate with heading, and speed with positions. If heading or positions are missing,
/// detects values that no wheeled vehicle reaches.
std::vector<Contradiction> motion_unit_contradictions(const Evidence& evidence);

}  // namespace awmr
