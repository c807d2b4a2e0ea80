/// The families of resistance, each a choice of the terms of resistance.h that are free.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace awmr {

enum class Family {
  kPower,                   ///< alpha w^beta: the paper's
  kCoulombLinear,           ///< c + alpha w
  kCoulombLinearQuadratic,  ///< c + alpha w + q w^2
  kCoulombPower,            ///< c + alpha w^beta
  kDeadZone,                ///< alpha w^beta against a command that loses a dead zone; surge only
};
inline constexpr std::array<Family, 5> kFamilies{Family::kPower, Family::kCoulombLinear,
                                                 Family::kCoulombLinearQuadratic,
                                                 Family::kCoulombPower, Family::kDeadZone};

/// Which of the curve's numbers a family leaves free; beta is 1 where it is not, the rest 0.
struct FamilyTerms {
  bool beta = false;
  bool coulomb = false;
  bool quadratic = false;
  bool dead_zone = false;
};
FamilyTerms terms_of(Family family);

/// "power", "coulomb-linear", "coulomb-linear-quadratic", "coulomb-power", "dead-zone".
std::string_view name_of(Family family);
std::optional<Family> family_by_name(std::string_view name);

}  // namespace awmr
