/// Names, in /estimates, of ratios of a family's terms that a coast-down alone can identify.
#pragma once

#include <string_view>

namespace awmr {

inline constexpr std::string_view kCoulombOverSurgeName = "surge.coulomb/surge.alpha";
inline constexpr std::string_view kQuadraticOverSurgeName = "surge.quadratic/surge.alpha";

}  // namespace awmr
