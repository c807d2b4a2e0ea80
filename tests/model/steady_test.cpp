/// Steady speeds and yaw rates, at which the resistance equals the force, are found if they exist,
/// and every search terminates.
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

TEST(Steady, BackEmfAddsToTheCurve) {
  const Resistance<double> power{.alpha = 1.2, .beta = 0.8};
  const Resistance<double> every{
      .alpha = 1.2, .beta = 0.8, .rest_speed = 0.0, .coulomb = 0.1, .quadratic = 0.05};
  for (const Resistance<double>& law : {power, every}) {
    for (const double force : {0.1001, 0.2, 1.0, 50.0}) {
      const auto rate = steady_rate(law, force, 1.6);
      ASSERT_TRUE(rate.has_value()) << force;
      EXPECT_NEAR(law.at(*rate) + 1.6 * *rate, force, 1e-12 * force);
    }
  }
}

/// Bisection to the last bit: slow, and correct for any rising curve.
double by_bisection(const Resistance<double>& law, double force) {
  double lo = 1e-300;
  double hi = 1e9;
  for (int i = 0; i < 2000 && std::nextafter(lo, hi) < hi; ++i) {
    // Uses the geometric mean first, because the ends can be hundreds of powers of ten apart.
    const double middle = hi > 2.0 * lo ? std::sqrt(lo) * std::sqrt(hi) : 0.5 * (lo + hi);
    (law.at(middle) < force ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

TEST(Steady, NewtonAgreesWithBisection) {
  for (const double alpha : {1e-6, 0.3, 1.2, 1e3}) {
    for (const double beta : {1e-3, 0.1, 0.5, 1.0, 2.0, 4.0}) {
      for (const double quadratic : {0.0, 1e-9, 0.05, 10.0}) {
        for (const double coulomb : {0.0, 0.1, 5.0}) {
          for (const double excess : {1e-9, 1e-3, 0.7, 4.0, 1e3}) {
            const Resistance<double> law{.alpha = alpha,
                                         .beta = beta,
                                         .rest_speed = 0.0,
                                         .coulomb = coulomb,
                                         .quadratic = quadratic};
            const double force = coulomb + excess;
            const double truth = by_bisection(law, force);
            if (truth > 1e8 || truth < 1e-290) continue;
            const auto rate = steady_rate(law, force);
            ASSERT_TRUE(rate) << alpha << ' ' << beta << ' ' << quadratic << ' ' << coulomb << ' '
                              << excess;
            // A relative rounding error of g, which includes c, changes the root w by g/(w g')
            // times this error. Tolerance: eight roundings, for the few operations of both methods.
            const double slope =
                (beta * alpha * std::pow(truth, beta) + 2.0 * quadratic * truth * truth) / force;
            EXPECT_NEAR(*rate, truth, 8.0 * 2.3e-16 / slope * truth)
                << alpha << ' ' << beta << ' ' << quadratic << ' ' << coulomb << ' ' << excess;
          }
        }
      }
    }
  }
}

TEST(Steady, AForceBelowFrictionHasNoSteadyRate) {
  const Resistance<double> law{.alpha = 1.2, .beta = 0.8, .rest_speed = 0.0, .coulomb = 0.1};
  EXPECT_FALSE(steady_rate(law, 0.1).has_value());
  EXPECT_FALSE(steady_rate(law, 0.05).has_value());
  EXPECT_FALSE(steady_rate(law, -1.0).has_value());
  EXPECT_FALSE(steady_rate({.alpha = 1.2, .beta = 0.8}, 0.0).has_value());
}

TEST(Steady, TheTimeToRestIsTheIntegralDownToRest) {
  // Times to rest by integration:
  // m' du/dt = -(c + a u):  t = (m'/a) ln(1 + a u0/c)
  // m' du/dt = -a u^b:      t = m' u0^(1 - b)/((1 - b) a)
  const Resistance<double> linear{.alpha = 0.8, .beta = 1.0, .rest_speed = 0.0, .coulomb = 0.1};
  EXPECT_NEAR(*stop_time_s(linear, 0.5, 2.0), 0.5 / 0.8 * std::log(1.0 + 0.8 * 2.0 / 0.1), 1e-9);
  const Resistance<double> power{.alpha = 0.8, .beta = 0.5};
  EXPECT_NEAR(*stop_time_s(power, 0.5, 2.0), 0.5 * std::sqrt(2.0) / (0.5 * 0.8), 1e-12);
  EXPECT_FALSE(stop_time_s({.alpha = 0.8, .beta = 1.0}, 0.5, 2.0).has_value());
}

TEST(Steady, TheSearchEndsWhereTheCurveJumpsAtRest) {
  // With beta = 0 the curve jumps from 0 to c + alpha = 1.3 at rest, and the force 0.2 is inside
  // the jump. A search by halving the speed would not terminate.
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
