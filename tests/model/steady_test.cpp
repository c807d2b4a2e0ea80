/// Steady rates: found where there is one, and every search for one ends.
#include "awmr/model/steady.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace awmr::testing {
namespace {

TEST(Steady, TheRateIsTheRootOfTheCurve) {
  const Resistance<double> law{
      .alpha = 1.2, .beta = 0.8, .rest_speed = 0.0, .coulomb = 0.1, .quadratic = 0.05};
  for (const double force : {0.1001, 0.2, 1.0, 50.0}) {
    const auto rate = steady_rate(law, force);
    ASSERT_TRUE(rate.has_value()) << force;
    EXPECT_NEAR(law.at(*rate), force, 1e-12 * force);
  }
}

TEST(Steady, AForceThatDoesNotOvercomeFrictionHasNone) {
  const Resistance<double> law{.alpha = 1.2, .beta = 0.8, .rest_speed = 0.0, .coulomb = 0.1};
  EXPECT_FALSE(steady_rate(law, 0.1).has_value());
  EXPECT_FALSE(steady_rate(law, 0.05).has_value());
  EXPECT_FALSE(steady_rate(law, -1.0).has_value());
}

TEST(Steady, TheSearchEndsWhereTheCurveJumpsAtRest) {
  // beta = 0: the curve starts at c + alpha = 1.3, so 0.2 lies in the jump and halving the speed
  // went on for ever.
  const Resistance<double> law{
      .alpha = 1.2, .beta = 0.0, .rest_speed = 0.0, .coulomb = 0.1, .quadratic = 0.05};
  EXPECT_FALSE(steady_rate(law, 0.2).has_value());
  EXPECT_TRUE(steady_rate(law, 1.4).has_value());
}

TEST(Steady, TheSearchEndsForEveryNumber) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {infinity, -infinity, std::nan(""), 1e308, 5e-324}) {
    const Resistance<double> sound{
        .alpha = 1.2, .beta = 0.8, .rest_speed = 0.0, .coulomb = 0.1, .quadratic = 0.05};
    Resistance<double> law = sound;
    const auto at_force = steady_rate(law, bad);
    EXPECT_TRUE(!at_force || std::isfinite(*at_force)) << bad;
    for (double Resistance<double>::*term :
         {&Resistance<double>::alpha, &Resistance<double>::beta, &Resistance<double>::coulomb,
          &Resistance<double>::quadratic}) {
      law = sound;
      law.*term = bad;
      const auto rate = steady_rate(law, 1.0);
      EXPECT_TRUE(!rate || std::isfinite(*rate)) << bad;
    }
  }
}

}  // namespace
}  // namespace awmr::testing
