/// float_math.h compared with the C library's double functions, whose error (1e-16) is negligible.
#include "awmr/model/float_math.h"
#include "awmr/model/float_bearing.h"
#include "awmr/model/quick_sin.h"
#include "awmr/model/scalar_math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace awmr::testing {
namespace {

/// Step between the tested bit patterns of floats; 1 (with AWMR_EXHAUSTIVE set) tests every float.
std::uint32_t stride() { return std::getenv("AWMR_EXHAUSTIVE") != nullptr ? 1U : 1009U; }

struct Worst {
  double absolute = 0.0;
  double relative = 0.0;
};

/// Worst errors of `f` compared with `reference` over the positive floats of [lo, hi] and their
/// negatives.
template <class F, class Reference>
Worst worst_error(float lo, float hi, F f, Reference reference) {
  Worst worst;
  for (std::uint64_t bits = std::bit_cast<std::uint32_t>(lo);
       bits <= std::bit_cast<std::uint32_t>(hi); bits += stride()) {
    const float magnitude = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    for (const float x : {magnitude, -magnitude}) {
      const double exact = reference(static_cast<double>(x));
      const double error = std::abs(static_cast<double>(f(x)) - exact);
      worst.absolute = std::max(worst.absolute, error);
      worst.relative = std::max(worst.relative, error / std::abs(exact));
    }
  }
  ::testing::Test::RecordProperty("absolute", std::to_string(worst.absolute * 1e9) + "e-9");
  ::testing::Test::RecordProperty("relative", std::to_string(worst.relative * 1e9) + "e-9");
  return worst;
}

// The smallest normal float: the chip treats subnormal numbers differently.
constexpr float kMin = std::numeric_limits<float>::min();

TEST(FloatMath, SineAndCosineKeepTheirStatedErrorUpToTheLargestAngle) {
  const auto sine = worst_error(
      kMin, float_math::kAngleMax, [](float x) { return float_math::sin(x); },
      [](double x) { return std::sin(x); });
  EXPECT_LT(sine.absolute, 7.9e-8);
  const auto cosine = worst_error(
      kMin, float_math::kAngleMax, [](float x) { return float_math::cos(x); },
      [](double x) { return std::cos(x); });
  EXPECT_LT(cosine.absolute, 7.9e-8);
}

TEST(FloatMath, QuickSineAndCosineKeepTheirStatedError) {
  double largest = 0.0;
  for (int i = -1'000'000; i <= 1'000'000; ++i) {
    const float x = 1e-4F * static_cast<float>(i);
    const double exact = static_cast<double>(x);
    largest =
        std::max(largest, std::abs(static_cast<double>(math::quick_sin(x)) - std::sin(exact)));
    largest =
        std::max(largest, std::abs(static_cast<double>(math::quick_cos(x)) - std::cos(exact)));
  }
  EXPECT_LT(largest, 9e-5);
  EXPECT_EQ(math::quick_sin(0.0F), 0.0F);
  EXPECT_LE(std::abs(math::quick_cos(0.0F)), 1.0F);
  EXPECT_TRUE(std::isnan(math::quick_sin(std::nanf(""))));
  EXPECT_TRUE(std::isnan(math::quick_cos(8193.0F)));
}

TEST(FloatMath, ArcTangentKeepsItsStatedErrorOverAllFloats) {
  const auto worst = worst_error(
      kMin, std::numeric_limits<float>::max(), [](float x) { return float_math::atan(x); },
      [](double x) { return std::atan(x); });
  EXPECT_LT(worst.relative, 9e-7);
}

TEST(FloatMath, AngleOfAVectorKeepsItsStatedErrorInEveryDirection) {
  double worst = 0.0;
  for (int i = 0; i < 400000; ++i) {
    const double direction = -3.14159 + 6.28318 * i / 400000.0;
    const double length = std::exp2(i % 41 - 20);
    const auto x = static_cast<float>(length * std::cos(direction));
    const auto y = static_cast<float>(length * std::sin(direction));
    const double exact = std::atan2(static_cast<double>(y), static_cast<double>(x));
    worst = std::max(worst, std::abs(static_cast<double>(float_math::atan2(y, x)) - exact));
  }
  EXPECT_LT(worst, 5e-7);
}

TEST(FloatMath, BearingKeepsItsStatedErrorInEveryDirectionAndAtEveryLength) {
  double worst = 0.0;
  for (int i = 0; i < 400000; ++i) {
    const double direction = -3.14159 + 6.28318 * i / 400000.0;
    const double length = std::exp2(i % 227 - 99);  // 2^-99 is 1.6e-30
    const auto x = static_cast<float>(length * std::cos(direction));
    const auto y = static_cast<float>(length * std::sin(direction));
    const double exact = std::atan2(static_cast<double>(y), static_cast<double>(x));
    const auto bearing = static_cast<double>(float_math::bearing(y, x));
    ASSERT_TRUE(bearing > -3.14159266 && bearing < 3.14159266) << direction;
    worst = std::max(worst, std::abs(std::remainder(bearing - exact, 2.0 * std::acos(-1.0))));
  }
  EXPECT_LT(worst, 4.1e-5);
}

TEST(FloatMath, BearingAtTheAxesAndTheDiagonalsIsWithinItsLastPlace) {
  // Bearings are multiples of 2^-17 rad, so the rounding error is up to half of that; pi is rounded
  // down.
  constexpr double kUnit = 1.0 / 131072.0;
  constexpr double kQuarter = 1.5707963267948966;
  EXPECT_EQ(float_math::bearing(0.0F, 2.0F), 0.0F);
  EXPECT_NEAR(float_math::bearing(3.0F, 0.0F), kQuarter, 0.5 * kUnit);
  EXPECT_NEAR(float_math::bearing(-3.0F, 0.0F), -kQuarter, 0.5 * kUnit);
  EXPECT_NEAR(float_math::bearing(0.0F, -1.0F), 2.0 * kQuarter, kUnit);
  // A ratio of 1 is stored as 1 - 2^-16, and the polynomial adds 1.2e-5.
  EXPECT_NEAR(float_math::bearing(1.0F, 1.0F), 0.5 * kQuarter, 2.5e-5);
  EXPECT_NEAR(float_math::bearing(-1.0F, -1.0F), -1.5 * kQuarter, 3e-5);
}

TEST(FloatMath, BearingOfNonFiniteInputIsNaN) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float x : {infinity, -infinity, std::nanf("")}) {
    EXPECT_TRUE(std::isnan(float_math::bearing(x, 1.0F)));
    EXPECT_TRUE(std::isnan(float_math::bearing(1.0F, x)));
    EXPECT_TRUE(std::isnan(float_math::bearing(x, x)));
  }
  const float largest = std::numeric_limits<float>::max();
  EXPECT_NEAR(float_math::bearing(largest, largest), 0.78539816, 2.5e-5);
}

TEST(FloatMath, AnglesOfTheAxesAndOfTheOriginAreExact) {
  EXPECT_EQ(float_math::atan2(0.0F, 0.0F), 0.0F);
  EXPECT_EQ(float_math::atan2(0.0F, 2.0F), 0.0F);
  EXPECT_EQ(float_math::atan2(3.0F, 0.0F), float_math::kPiBy2);
  EXPECT_EQ(float_math::atan2(-3.0F, 0.0F), -float_math::kPiBy2);
  EXPECT_EQ(float_math::atan2(0.0F, -1.0F), float_math::kPi);
  EXPECT_EQ(float_math::atan2(-0.0F, -1.0F), float_math::kPi);
  // A vector slightly below the negative x axis has the angle +pi, not -pi.
  for (const float hair : {-1e-45F, -1e-30F, -1e-8F}) {
    EXPECT_EQ(float_math::atan2(hair, -1.0F), float_math::kPi) << hair;
    EXPECT_GT(float_math::bearing(hair, -1.0F), -float_math::kPi) << hair;
  }
}

TEST(FloatMath, SteeringAngleKeepsItsStatedError) {
  const auto angle = [](float q) { return float_math::twice_atan(q); };
  const auto exact = [](double q) { return 2.0 * std::atan(q); };
  EXPECT_LT(worst_error(kMin, 0.2F, angle, exact).relative, 5e-7);
  EXPECT_LT(worst_error(0.2F, 1.0F, angle, exact).relative, 9e-7);
}

TEST(FloatMath, WrapsIntoMinusPiToPiAndChangesNothingThere) {
  double worst = 0.0;
  for (std::uint64_t bits = std::bit_cast<std::uint32_t>(1e-3F);
       bits <= std::bit_cast<std::uint32_t>(float_math::kAngleMax); bits += stride()) {
    const float magnitude = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    for (const float x : {magnitude, -magnitude}) {
      const float wrapped = float_math::wrapped(x);
      ASSERT_TRUE(wrapped > -float_math::kPi && wrapped <= float_math::kPi) << x;
      if (x > -float_math::kPi && x <= float_math::kPi) {
        ASSERT_EQ(wrapped, x);
      }
      const double off = std::remainder(static_cast<double>(wrapped) - static_cast<double>(x),
                                        2.0 * 3.14159265358979323846);
      worst = std::max(worst, std::abs(off));
    }
  }
  EXPECT_LT(worst, 5e-7);
}

TEST(FloatMath, WrapsAtEveryOddMultipleOfPi) {
  // Cases in which rounding may put the reduced angle on either side of pi.
  for (int turns = 1; turns <= 2607; turns += 2) {
    float x = static_cast<float>(turns * 3.14159265358979323846);
    for (int i = 0; i < 8; ++i) x = std::nextafter(x, 0.0F);
    for (int i = 0; i < 16; ++i, x = std::nextafter(x, 1e4F)) {
      for (const float angle : {x, -x}) {
        if (!(std::abs(angle) <= float_math::kAngleMax)) continue;
        const float wrapped = float_math::wrapped(angle);
        ASSERT_TRUE(wrapped > -float_math::kPi && wrapped <= float_math::kPi) << angle;
        ASSERT_LT(std::abs(std::remainder(static_cast<double>(wrapped) - static_cast<double>(angle),
                                          2.0 * 3.14159265358979323846)),
                  5e-7)
            << angle;
      }
    }
  }
}

TEST(FloatMath, OrdersAsTheOperatorsDo) {
  const float nan = std::nanf("");
  const float inf = std::numeric_limits<float>::infinity();
  for (const float x : {-inf, -2.0F, -1e-40F, -0.0F, 0.0F, 1e-40F, 2.0F, inf, nan}) {
    for (const float y : {-inf, -2.0F, -1e-40F, -0.0F, 0.0F, 1e-40F, 2.0F, inf, nan}) {
      EXPECT_EQ(math::is_above(x, y), x > y) << x << " > " << y;
    }
  }
}

TEST(FloatMath, RatioIsToTheNearestOfSixteenBits) {
  // Tests random numbers with 16-bit mantissas and different exponents.
  for (std::uint32_t i = 0; i < 200'000; ++i) {
    const std::uint32_t hash = i * 2654435761U;
    const std::uint32_t apart = hash % 19U;
    const std::uint32_t large = (100U << 23U) | ((hash >> 7U) & 0x7FFF00U);
    const std::uint32_t small = ((100U - apart) << 23U) | ((i * 40503U) & 0x7FFF00U);
    if (small > large) continue;
    const double exact = static_cast<double>(std::bit_cast<float>(small)) /
                         static_cast<double>(std::bit_cast<float>(large)) * 65536.0;
    const double nearest = apart > 16 ? 0.0 : std::min(std::floor(exact + 0.5), 65535.0);
    ASSERT_EQ(float_math::detail::ratio16(small, large), nearest) << apart;
  }
}

TEST(FloatMath, NonFiniteAnglesGiveNaN) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float x : {infinity, -infinity, std::nanf(""), 8200.0F, -1e30F}) {
    EXPECT_TRUE(std::isnan(float_math::sin(x)));
    EXPECT_TRUE(std::isnan(float_math::cos(x)));
    EXPECT_TRUE(std::isnan(float_math::wrapped(x)));
  }
  EXPECT_TRUE(std::isnan(float_math::atan(std::nanf(""))));
  EXPECT_TRUE(std::isnan(float_math::atan2(std::nanf(""), 1.0F)));
  EXPECT_TRUE(std::isnan(float_math::atan2(1.0F, std::nanf(""))));
  EXPECT_EQ(float_math::atan(infinity), float_math::kPiBy2);
  EXPECT_EQ(float_math::atan(-infinity), -float_math::kPiBy2);
}

}  // namespace
}  // namespace awmr::testing
