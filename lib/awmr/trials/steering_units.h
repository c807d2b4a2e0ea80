/// Checks the unit of the steering angle in a log. Private to this folder.
#pragma once

#include <optional>

#include "awmr/trials/log_evidence.h"

namespace awmr {

/// Detects values that are not steering angles in degrees: radians, and a servo's angle, pulse
/// length, percent or counts. Also detects any angle other than 0 of a vehicle without steering.
std::optional<Contradiction> steering_unit_contradiction(const Evidence& evidence);

}  // namespace awmr
