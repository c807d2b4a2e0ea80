/// Thresholds below which a speed, yaw rate or force counts as 0, because simulators and filters
/// may write a tiny number such as 3.9e-312 instead of 0. No vehicle moves as slowly as the
/// thresholds. Private to this folder.
#pragma once

#include <cmath>

namespace awmr {

inline constexpr double kRestSpeed_mps = 1e-6;
inline constexpr double kRestRate_radps = 1e-6;
inline constexpr double kRestForce = 1e-6;  ///< F', force over F_max

/// True if the magnitude of `value` is below `limit`.
inline bool is_rest(double value, double limit) { return std::abs(value) < limit; }

}  // namespace awmr
