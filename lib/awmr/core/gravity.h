/// The standard acceleration of gravity, m/s^2.
#pragma once

namespace awmr {

inline constexpr double kGravity_mps2 = 9.80665;

}  // namespace awmr
