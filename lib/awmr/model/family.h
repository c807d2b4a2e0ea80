/// The families of resistance (friction models). Each frees some of the terms of resistance.h.
#pragma once

#include <string_view>

#include "awmr/core/name_table.h"

namespace awmr {

enum class Family {
  kPower,                   ///< alpha w^beta, as in the paper
  kCoulombLinear,           ///< c + alpha w
  kCoulombLinearQuadratic,  ///< c + alpha w + q w^2
  kCoulombPower,            ///< c + alpha w^beta
  kDeadZone,                ///< alpha w^beta with a dead zone of the command; surge only
};
inline constexpr NameTable<Family, 5> kFamilyNames{
    {{"power", Family::kPower},
     {"coulomb-linear", Family::kCoulombLinear},
     {"coulomb-linear-quadratic", Family::kCoulombLinearQuadratic},
     {"coulomb-power", Family::kCoulombPower},
     {"dead-zone", Family::kDeadZone}}};
constexpr std::string_view name_of(Family family) { return name_in(kFamilyNames, family); }

/// Free parameters of a family's curve; if not free, beta is 1 and the others are 0.
struct FamilyTerms {
  bool beta = false;
  bool coulomb = false;
  bool quadratic = false;
  bool dead_zone = false;
};
FamilyTerms terms_of(Family family);

}  // namespace awmr
