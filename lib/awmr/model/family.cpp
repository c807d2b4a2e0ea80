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

std::string_view name_of(Family family) {
  switch (family) {
    case Family::kPower:
      return "power";
    case Family::kCoulombLinear:
      return "coulomb-linear";
    case Family::kCoulombLinearQuadratic:
      return "coulomb-linear-quadratic";
    case Family::kCoulombPower:
      return "coulomb-power";
    case Family::kDeadZone:
      return "dead-zone";
  }
  return {};
}

std::optional<Family> family_by_name(std::string_view name) {
  for (const Family family : kFamilies) {
    if (name_of(family) == name) return family;
  }
  return std::nullopt;
}

}  // namespace awmr
