/// Names, in /estimates of model.json, of the ratios c1/a1 and q1/a1: Coulomb and quadratic part of
/// the surge resistance over its coefficient a1. If there is no surge trial, a coast-down can
/// identify only these ratios.
#pragma once

#include <string_view>

namespace awmr {

inline constexpr std::string_view kCoulombOverSurgeName = "surge.coulomb/surge.alpha";
inline constexpr std::string_view kQuadraticOverSurgeName = "surge.quadratic/surge.alpha";

}  // namespace awmr
