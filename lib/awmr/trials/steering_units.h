/// Checks the unit of the steering angle in a log. Private to this folder.
#pragma once

#include <optional>

#include "awmr/trials/log_evidence.h"

namespace awmr {

/// Detects steering angles in radians, a servo's angle, pulse, percent or counts, and any angle of
/// a vehicle without steering.
std::optional<Contradiction> steering_unit_contradiction(const Evidence& evidence);

}  // namespace awmr
