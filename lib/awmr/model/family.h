/// The families of resistance, each a choice of the terms of resistance.h that are free.
#pragma once

#include <string_view>

#include "awmr/core/name_table.h"

namespace awmr {

enum class Family {
  kPower,                   ///< alpha w^beta: the paper's
  kCoulombLinear,           ///< c + alpha w
  kCoulombLinearQuadratic,  ///< c + alpha w + q w^2
  kCoulombPower,            ///< c + alpha w^beta
  kDeadZone,                ///< alpha w^beta against a command that loses a dead zone; surge only
};
inline constexpr NameTable<Family, 5> kFamilyNames{
    {{"power", Family::kPower},
     {"coulomb-linear", Family::kCoulombLinear},
     {"coulomb-linear-quadratic", Family::kCoulombLinearQuadratic},
     {"coulomb-power", Family::kCoulombPower},
     {"dead-zone", Family::kDeadZone}}};
constexpr std::string_view name_of(Family family) { return name_in(kFamilyNames, family); }

/// Which of the curve's numbers a family leaves free; beta is 1 where it is not, the rest 0.
struct FamilyTerms {
  bool beta = false;
  bool coulomb = false;
  bool quadratic = false;
  bool dead_zone = false;
};
FamilyTerms terms_of(Family family);

}  // namespace awmr
