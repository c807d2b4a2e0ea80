/// Position from late and noisy fixes and dead reckoning: the filter's equations, latency,
/// drop-outs, jumps.
#include "awmr/control/position_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace awmr::testing {
namespace {

constexpr double kStep_s = 0.01;

/// A vehicle at a constant speed and yaw rate with a receiver that sends every 0.2 s, 0.2 s late.
template <class T>
class Drive {
 public:
  explicit Drive(const PositionFilter<T>& filter, double u_mps = 1.0, double r_radps = 0.0)
      : estimate_(filter), u_mps_(u_mps), r_radps_(r_radps) {}

  /// Simulates one step. The errors are added to a fix that arrives in this step.
  Position<T> step(double error_x_m = 0.0, double error_y_m = 0.0, bool is_lost = false) {
    const double psi = r_radps_ * time_s();
    const bool arrives = steps_ % 20 == 0 && steps_ >= 20 && !is_lost;
    if (arrives) {
      const Position<double> then = at(time_s() - 0.2);
      fix_ = {{T(then.x_m + error_x_m), T(then.y_m + error_y_m)}, T(0.2), true};
    }
    fix_.is_new = arrives;
    fix_.age_s = T(arrives ? 0.2 : 1.0);
    ++steps_;
    return shown_ =
               estimate_.step(fix_, {T(psi), T(u_mps_ + speed_error_mps), T(0.0), T(r_radps_)});
  }
  void run(double duration_s, bool is_lost = false) {
    for (int i = 0; i < std::lround(duration_s / kStep_s); ++i) step(0.0, 0.0, is_lost);
  }
  /// Distance of the estimate from the vehicle.
  double error_m() const {
    const Position<double> true_m = at((steps_ - 1) * kStep_s);
    return std::hypot(double(shown_.x_m) - true_m.x_m, double(shown_.y_m) - true_m.y_m);
  }
  bool is_fix_due() const { return steps_ % 20 == 0; }
  int resets() const { return estimate_.resets; }
  double speed_error_mps = 0.0;

 private:
  double time_s() const { return steps_ * kStep_s; }
  Position<double> at(double t_s) const {
    if (r_radps_ == 0.0) return {u_mps_ * t_s, 0.0};
    const double radius_m = u_mps_ / r_radps_;
    return {radius_m * std::sin(r_radps_ * t_s), radius_m * (1.0 - std::cos(r_radps_ * t_s))};
  }

  PositionEstimate<T> estimate_;
  PositionFix<T> fix_ = {{T(0.0), T(0.0)}, T(0.0), false};
  Position<T> shown_ = {};
  double u_mps_, r_radps_;
  int steps_ = 0;
};

/// In a turn the direction of the estimated motion lags by up to 5 steps: the motion is read in
/// three steps, held for three and integrated from the step before. At r = 0.5 rad/s, 5 steps are
/// 0.025 rad, which on a circle of 2 m is a displacement of 0.05 m.
TEST(PositionEstimate, FollowsTheVehicleBetweenFixes) {
  Drive<double> straight(position_filter<double>(1.5, 0.2, kStep_s));
  Drive<double> turn(position_filter<double>(1.5, 0.2, kStep_s), 1.0, 0.5);
  for (int i = 0; i < 3000; ++i) {
    straight.step();
    turn.step();
    if (i < 3) continue;  // the first three steps have no direction yet
    EXPECT_LT(straight.error_m(), 0.021) << i;
    EXPECT_LT(turn.error_m(), 0.08) << i;
  }
  // A fix is compared with where the vehicle was 0.2 s before: no lag remains.
  EXPECT_LT(straight.error_m(), 1e-3);
}

TEST(PositionEstimate, IsTheSameInFloat) {
  Drive<float> in_float(position_filter<float>(1.5, 0.2, kStep_s), 1.0, 0.3);
  Drive<double> in_double(position_filter<double>(1.5, 0.2, kStep_s), 1.0, 0.3);
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1.5);
  for (int i = 0; i < 6000; ++i) {
    const double x = noise(random);
    const double y = noise(random);
    const auto a = in_float.step(x, y);
    const auto b = in_double.step(x, y);
    // Tolerance: 9e-5 of the 60 m that were driven, plus rounding.
    EXPECT_NEAR(a.x_m, b.x_m, 0.01);
    EXPECT_NEAR(a.y_m, b.y_m, 0.01);
  }
}

/// With q = 0 the filter's gains are 1/2, 1/3, ...: the mean of all fixes.
TEST(PositionEstimate, AveragesTheFirstFixes) {
  PositionFilter<double> filter = position_filter<double>(1.5, 0.2, kStep_s);
  filter.drift_m2 = 0.0;
  PositionEstimate<double> estimate(filter);
  const Measurement<double> rest{0.3, 0.0, 0.0, 0.0};
  double sum_m = 0.0;
  for (int n = 1; n <= 10; ++n) {
    const double fix_m = n * n % 7;
    sum_m += fix_m;
    Position<double> at{};
    for (int i = 0; i < 20; ++i) at = estimate.step({{fix_m, -fix_m}, 0.2, i == 0}, rest);
    EXPECT_NEAR(at.x_m, sum_m / n, 1e-12);
    EXPECT_NEAR(at.y_m, -sum_m / n, 1e-12);
  }
}

/// In the steady state of P += q t (between two fixes) and P -= P^2/(P + R) (at a fix), the
/// variance after a fix satisfies P^2 = q t R - P q t.
TEST(PositionEstimate, HasTheSteadyGainOfTheFilter) {
  Drive<double> drive(position_filter<double>(1.5, 0.2, kStep_s));
  drive.run(60.0);
  const double grown = kDrift_m2ps * 0.2;
  const double variance = 0.5 * (-grown + std::sqrt(grown * grown + 4.0 * grown * 2.25));
  const double gain = (variance + grown) / (variance + grown + 2.25);
  EXPECT_NEAR(gain, 0.064, 0.001);
  ASSERT_TRUE(drive.is_fix_due());
  drive.step(0.0, 1.0);
  double before = drive.step().y_m;
  for (int i = 0; i < 18; ++i) {
    const double now = drive.step().y_m;
    // The correction is spread over 8 steps.
    EXPECT_LT(now - before, gain / 8.0 + 1e-6);
    before = now;
  }
  EXPECT_NEAR(before, gain, 1e-4);
}

/// With a speed error of 0.1 m/s the estimate drifts by 0.3 m in 3 s without fixes. The next fixes
/// then have a larger gain.
TEST(PositionEstimate, SurvivesADropOutOfThreeSeconds) {
  Drive<double> drive(position_filter<double>(1.5, 0.2, kStep_s));
  drive.run(30.0);
  drive.speed_error_mps = 0.1;
  drive.run(3.0, true);
  EXPECT_NEAR(drive.error_m(), 0.3, 0.01);
  drive.speed_error_mps = 0.0;
  drive.run(10.0);
  EXPECT_LT(drive.error_m(), 0.02);
  EXPECT_EQ(drive.resets(), 0);
}

TEST(PositionEstimate, DoesNotUseAFixThatJumps) {
  Drive<double> drive(position_filter<double>(1.5, 0.2, kStep_s));
  drive.run(30.0);
  for (int fixes = 0; fixes < kRejections - 1; ++fixes) {
    ASSERT_TRUE(drive.is_fix_due());
    drive.step(30.0, 0.0);
    for (int i = 0; i < 19; ++i) drive.step();
    EXPECT_LT(drive.error_m(), 0.021);
  }
  drive.run(10.0);
  EXPECT_EQ(drive.resets(), 0);
  EXPECT_LT(drive.error_m(), 0.021);
}

TEST(PositionEstimate, ResetsAfterFiveRejectedFixesAndReportsIt) {
  Drive<double> drive(position_filter<double>(1.5, 0.2, kStep_s));
  drive.run(30.0);
  for (int fixes = 0; fixes < kRejections; ++fixes) {
    EXPECT_EQ(drive.resets(), 0);
    for (int i = 0; i < 20; ++i) drive.step(30.0, 0.0);
  }
  EXPECT_EQ(drive.resets(), 1);
  EXPECT_NEAR(drive.error_m(), 30.0, 0.02);
  for (int i = 0; i < 2000; ++i) drive.step(30.0, 0.0);
  EXPECT_EQ(drive.resets(), 1);
  EXPECT_NEAR(drive.error_m(), 30.0, 0.02);
}

TEST(PositionEstimate, DoesTheWorkOnAFixAtOnceWhereStepsAreLong) {
  constexpr double kLong_s = 0.05;
  PositionEstimate<double> estimate(position_filter<double>(0.0, 0.2, kLong_s));
  const Measurement<double> rest{0.0, 0.0, 0.0, 0.0};
  estimate.step({{0.0, 0.0}, 0.0, true}, rest);
  estimate.step({{0.05, 0.0}, 0.2, true}, rest);
  // With these long steps, a correction is spread over two steps (kSpread_s). Its gain is K = (R +
  // q t)/(2 R + q t) = 0.963 with R = 1e-4 m^2 and q t = 0.0025 m^2.
  estimate.step({{0.05, 0.0}, 0.2, false}, rest);
  EXPECT_NEAR(estimate.step({{0.05, 0.0}, 0.2, false}, rest).x_m, 0.963 * 0.05, 1e-5);
}

TEST(PositionEstimate, RejectsANonFiniteFix) {
  PositionEstimate<float> estimate(position_filter<float>(1.5, 0.2, kStep_s));
  const Measurement<float> rest{0.0F, 0.0F, 0.0F, 0.0F};
  estimate.step({{1.0F, 2.0F}, 0.0F, true}, rest);
  Position<float> at{};
  for (int i = 0; i < 20; ++i) at = estimate.step({{std::nanf(""), 2.0F}, 0.2F, i == 0}, rest);
  EXPECT_EQ(at.x_m, 1.0F);
  EXPECT_EQ(at.y_m, 2.0F);
}

TEST(PositionEstimate, RingReachesBackToTheLatency) {
  for (const double latency_s : {0.0, 0.05, 0.2, 0.5, 2.0}) {
    for (const double step_s : {0.002, 0.01, 0.05, 0.1}) {
      const auto filter = position_filter<double>(1.5, latency_s, step_s);
      EXPECT_GE((kTravelled - 2) * filter.stride * step_s, latency_s + 0.1 - 1e-9);
      EXPECT_EQ(filter.stride * filter.stride_inverse, 1.0);
    }
  }
  EXPECT_EQ(position_filter<double>(1.5, 1e6, 0.01).stride, 255);
}

}  // namespace
}  // namespace awmr::testing
