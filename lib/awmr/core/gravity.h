/// The standard acceleration of gravity.
#pragma once

namespace awmr {

inline constexpr double kGravity_mps2 = 9.80665;

}  // namespace awmr
