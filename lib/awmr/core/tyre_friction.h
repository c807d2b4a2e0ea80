/// What a tyre holds, over the weight on it.
#pragma once

namespace awmr {

/// Of rubber on a dry floor or road.
inline constexpr double kTyreFriction = 0.8;

}  // namespace awmr
