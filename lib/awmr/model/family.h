/// The families of resistance (friction models). A family is a law for the force or moment that
/// resists a speed w > 0. It has some of the terms of the general law in resistance.h.
#pragma once

#include <string_view>

#include "awmr/core/name_table.h"

namespace awmr {

enum class Family {
  kPower,                   ///< alpha w^beta, as in the paper
  kCoulombLinear,           ///< c + alpha w
  kCoulombLinearQuadratic,  ///< c + alpha w + q w^2
  kCoulombPower,            ///< c + alpha w^beta
  kDeadZone,                ///< alpha w^beta, and motor commands with a dead zone; surge only
  /// c + alpha w^beta, and motor commands with a dead zone; surge only, and only in logs: steady
  /// runs show only the sum of Coulomb friction and dead zones.
  kDeadZoneCoulomb,
};
inline constexpr NameTable<Family, 6> kFamilyNames{
    {{"power", Family::kPower},
     {"coulomb-linear", Family::kCoulombLinear},
     {"coulomb-linear-quadratic", Family::kCoulombLinearQuadratic},
     {"coulomb-power", Family::kCoulombPower},
     {"dead-zone", Family::kDeadZone},
     {"dead-zone-coulomb", Family::kDeadZoneCoulomb}}};
constexpr std::string_view name_of(Family family) { return name_in(kFamilyNames, family); }

/// Parameters that a fit of the family estimates, in addition to alpha. Parameters that the family
/// does not have are fixed: beta at 1, Coulomb friction, quadratic part and dead zone at 0.
struct FamilyTerms {
  bool beta = false;
  bool coulomb = false;
  bool quadratic = false;
  bool dead_zone = false;
};
FamilyTerms terms_of(Family family);

/// The family with the same terms except the dead zone.
Family without_dead_zone(Family family);

}  // namespace awmr
