#include "awmr/identify/tables/transformed_parameter.h"

#include <cmath>

namespace awmr {

std::vector<TransformedParameter> coordinates_of(Family family) {
  const FamilyTerms terms = terms_of(family);
  std::vector<TransformedParameter> free{TransformedParameter::kLogAlpha};
  if (terms.beta) free.push_back(TransformedParameter::kBeta);
  if (terms.coulomb) free.push_back(TransformedParameter::kCoulomb);
  if (terms.quadratic) free.push_back(TransformedParameter::kQuadratic);
  if (terms.dead_zone) free.push_back(TransformedParameter::kDeadZone);
  return free;
}

double value_from(TransformedParameter c, double coordinate) {
  if (c == TransformedParameter::kLogAlpha) return std::exp(coordinate);
  if (c == TransformedParameter::kDeadZone) return coordinate / 4.0;
  return coordinate;
}

Interval values_from(TransformedParameter c, const Interval& coordinate) {
  return {value_from(c, coordinate.lo), value_from(c, coordinate.hi)};
}

double jacobian_of(TransformedParameter c, double coordinate) {
  if (c == TransformedParameter::kLogAlpha) return std::exp(coordinate);
  return c == TransformedParameter::kDeadZone ? 0.25 : 1.0;
}

}  // namespace awmr
