#include "awmr/model/family.h"

namespace awmr {

FamilyTerms terms_of(Family family) {
  switch (family) {
    case Family::kPower:
      return {.beta = true};
    case Family::kCoulombLinear:
      return {.coulomb = true};
    case Family::kCoulombLinearQuadratic:
      return {.coulomb = true, .quadratic = true};
    case Family::kCoulombPower:
      return {.beta = true, .coulomb = true};
    case Family::kDeadZone:
      return {.beta = true, .dead_zone = true};
    case Family::kDeadZoneCoulomb:
      return {.beta = true, .coulomb = true, .dead_zone = true};
  }
  return {};
}

Family without_dead_zone(Family family) {
  if (family == Family::kDeadZone) return Family::kPower;
  if (family == Family::kDeadZoneCoulomb) return Family::kCoulombPower;
  return family;
}

}  // namespace awmr
