/// Coordinate of each parameter in fits and draws (logarithm or the value itself), and its inverse.
#include "awmr/model/transform.h"

#include <gtest/gtest.h>

namespace awmr::testing {
namespace {

TEST(Transform, KeepsExponentsAndTermsLinearAndTakesTheLogarithmOfTheRest) {
  for (const ParameterInfo& parameter : parameter_table()) {
    const bool exponent =
        parameter.id == ParameterId::kSurgeBeta || parameter.id == ParameterId::kYawBeta;
    EXPECT_EQ(scale_of(parameter.id),
              exponent || parameter.term ? Scale::kLinear : Scale::kLogarithmic)
        << parameter.name;
  }
  EXPECT_EQ(to_coordinate(ParameterId::kSurgeCoulomb, 0.0), 0.0);
}

/// Tolerances: exp(ln p) has an error of about |ln p| + 1 units in the last place. A central
/// difference with the step h has an error of h^2/6 of the value, plus rounding divided by h.
TEST(Transform, InvertsAndHasItsOwnDerivative) {
  constexpr double kValue = 0.37;
  constexpr double kStep = 1e-5;
  for (const ParameterInfo& parameter : parameter_table()) {
    const double z = to_coordinate(parameter.id, kValue);
    EXPECT_NEAR(from_coordinate(parameter.id, z), kValue, 1e-15) << parameter.name;
    const double difference =
        (from_coordinate(parameter.id, z + kStep) - from_coordinate(parameter.id, z - kStep)) /
        (2.0 * kStep);
    EXPECT_NEAR(jacobian(parameter.id, kValue), difference, 1e-10) << parameter.name;
  }
}

}  // namespace
}  // namespace awmr::testing
