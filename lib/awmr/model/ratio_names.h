/// Names, in /estimates of model.json, of the ratios c1/a1 and q1/a1 that a coast-down without a
/// surge trial can identify.
#pragma once

#include <string_view>

namespace awmr {

inline constexpr std::string_view kCoulombOverSurgeName = "surge.coulomb/surge.alpha";
inline constexpr std::string_view kQuadraticOverSurgeName = "surge.quadratic/surge.alpha";

}  // namespace awmr
