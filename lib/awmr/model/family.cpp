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
  }
  return {};
}

}  // namespace awmr
