#include "awmr/validate/circle_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace awmr::testing {
namespace {

std::vector<Position<double>> arc(double x_m, double y_m, double radius_m, double angle_rad,
                                  int count) {
  std::vector<Position<double>> points;
  for (int i = 0; i < count; ++i) {
    const double a = angle_rad * i / count;
    points.push_back({x_m + radius_m * std::cos(a), y_m + radius_m * std::sin(a)});
  }
  return points;
}

TEST(CircleFit, RecoversAFullCircleFarFromTheOrigin) {
  const auto circle = fit_circle(arc(1000.0, -300.0, 1.145, 2.0 * std::numbers::pi, 500));
  ASSERT_TRUE(circle);
  // The rounding error of a coordinate is 1000 * 2^-53 = 1.1e-13 m. Sums over 500 points err by
  // less than 100 times that.
  EXPECT_NEAR(circle->x_m, 1000.0, 1e-11);
  EXPECT_NEAR(circle->y_m, -300.0, 1e-11);
  EXPECT_NEAR(circle->radius_m, 1.145, 1e-11);
  EXPECT_LT(circle->deviation_m, 1e-11);
}

TEST(CircleFit, RecoversAQuarterArc) {
  const auto circle = fit_circle(arc(2.0, 3.0, 5.0, std::numbers::pi / 2.0, 200));
  ASSERT_TRUE(circle);
  // Tolerance: the equations of a quarter arc have a condition number of about 100, so rounding
  // causes an error of 1e-16 * 5 m * 100. The bound is 100 times as large.
  EXPECT_NEAR(circle->radius_m, 5.0, 5e-12);
}

TEST(CircleFit, MeasuresTheDeviationOfOnePointOut) {
  std::vector<Position<double>> points = arc(0.0, 0.0, 1.0, 2.0 * std::numbers::pi, 1000);
  points[0].x_m += 0.1;
  const auto circle = fit_circle(points);
  ASSERT_TRUE(circle);
  // A displacement of one of 1000 points by 0.1 m changes centre and radius by about 0.1/1000 * 2 m
  // each.
  EXPECT_NEAR(circle->deviation_m, 0.1, 1e-3);
}

TEST(CircleFit, RefusesALineAndTooFewPoints) {
  EXPECT_FALSE(fit_circle(std::vector<Position<double>>{{0.0, 0.0}, {1.0, 1.0}}));
  EXPECT_FALSE(
      fit_circle(std::vector<Position<double>>{{0.0, 0.0}, {1.0, 2.0}, {2.0, 4.0}, {3.0, 6.0}}));
  EXPECT_FALSE(fit_circle(std::vector<Position<double>>(10, Position<double>{1.0, 1.0})));
}

}  // namespace
}  // namespace awmr::testing
