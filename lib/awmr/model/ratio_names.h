/// How what a coast-down alone shows of a family's terms is called, in /estimates.
#pragma once

#include <string_view>

namespace awmr {

inline constexpr std::string_view kCoulombOverSurgeName = "surge.coulomb/surge.alpha";
inline constexpr std::string_view kQuadraticOverSurgeName = "surge.quadratic/surge.alpha";

}  // namespace awmr
