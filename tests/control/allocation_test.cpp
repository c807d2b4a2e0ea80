/// Allocations: inside the limits the wheel forces and the steering make exactly the requested
/// force and moment; outside the limits they are finite and ordered.
#include "awmr/control/allocation.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>

#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

constexpr YawMode kModes[] = {YawMode::kDifferential, YawMode::kSteering, YawMode::kCombined};

AllocationLimits<double> limits(CombinedSplit split = CombinedSplit::kRedistribute) {
  AllocationLimits<double> l = paper_controller_of<double>().limits;
  l.split = split;
  return l;
}

double drawn(double lo, double hi) {
  return lo + (hi - lo) * *rc::gen::inRange(0, 10001) / 10000.0;
}

GeneralisedForces<double> delivered(const Allocation<double>& a) {
  const auto l = limits();
  return generalised_forces(l.front_axle_m, l.half_track_m, a.force, a.steering_rad);
}

double moment(const Allocation<double>& a) {
  const auto tau = delivered(a);
  return tau.tau_steering_m + tau.tau_diff_m;
}

TEST(Allocation, DeliversExactlyWhatIsRequestedInsideTheLimits) {
  EXPECT_TRUE(rc::check([] {
    const double tau_speed = drawn(0.1, 2.0);
    // |d_r| < 20 deg needs |tau_turn| < l_f tau_speed tan(10 deg); the forces are then within
    // limits too.
    const double tau_turn_m = drawn(-1, 1) * 0.99 * 0.35 * tau_speed * std::tan(radians(10.0));
    for (const YawMode mode : kModes) {
      const Allocation<double> a = allocate(mode, tau_speed, tau_turn_m, limits());
      RC_ASSERT(!a.speed_limited && !a.steering_limited && !a.force_limited &&
                !a.steering_powerless);
      RC_ASSERT(std::abs(delivered(a).tau_speed - tau_speed) < 1e-14);
      RC_ASSERT(std::abs(moment(a) - tau_turn_m) < 1e-14);
    }
  }));
}

/// Independent reference: solves equation (41) of the paper numerically for each mode; slow.
class Reference41 {
 public:
  Reference41(const AllocationLimits<double>& its_limits) : l(its_limits) {}

  Allocation<double> operator()(YawMode mode, double tau_speed, double tau_turn_m) {
    const double speed = std::clamp(tau_speed, 4.0 * l.force_min, 4.0 * l.force_max);
    stop_rad =
        2.0 * std::atan(std::tan(0.5 * l.steering_max_rad) * std::clamp(16.0 * speed, 0.0, 1.0));
    if (mode == YawMode::kDifferential)
      return {with_forces(speed, tau_turn_m, 0.0), 0.0, {}, {}, {}, {}};
    if (mode == YawMode::kSteering) {
      const double steering_rad = angle_rad(speed, tau_turn_m);
      return {with_forces(speed, 0.0, steering_rad), steering_rad, {}, {}, {}, {}};
    }
    double steering_rad = angle_rad(speed, 0.5 * tau_turn_m);
    const bool redistributes = l.split == CombinedSplit::kRedistribute;
    const bool stopped = std::abs(steering_rad) >= stop_rad || speed < 1e-6;
    const double steered_m =
        l.front_axle_m * speed * std::sin(steering_rad) / (1.0 + std::cos(steering_rad));
    const SideForces<double> f = with_forces(
        speed, redistributes && stopped ? tau_turn_m - steered_m : 0.5 * tau_turn_m, steering_rad);
    if (redistributes && clipped && !stopped) {
      const auto made = generalised_forces(l.front_axle_m, l.half_track_m, f, steering_rad);
      steering_rad = angle_rad(made.tau_speed, tau_turn_m - made.tau_diff_m);
    }
    return {f, steering_rad, {}, {}, {}, {}};
  }

 private:
  /// Solves l_f tau_speed sin d_r/(1 + cos d_r) = moment for d_r, by bisection in [-stop, stop].
  double angle_rad(double speed, double moment_m) const {
    if (speed < 1e-6) return 0.0;
    double lo = -stop_rad, hi = stop_rad;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (lo + hi);
      const double made_m = l.front_axle_m * speed * std::sin(middle) / (1.0 + std::cos(middle));
      (made_m < moment_m ? lo : hi) = middle;
    }
    // Bisection approaches a stop without reaching it, so a result next to the stop counts as the
    // stop.
    const double found = 0.5 * (lo + hi);
    return stop_rad - std::abs(found) < 1e-15 ? std::copysign(stop_rad, found) : found;
  }
  /// F'L + F'R = tau_speed/(1 + cos d_r), F'R - F'L = tau_diff/(d (1 + cos d_r))
  SideForces<double> with_forces(double speed, double moment_m, double steering_rad) {
    const double sum = speed / (1.0 + std::cos(steering_rad));
    const double difference = moment_m / (l.half_track_m * (1.0 + std::cos(steering_rad)));
    const double left = 0.5 * (sum - difference);
    const double right = 0.5 * (sum + difference);
    const SideForces<double> f{std::clamp(left, l.force_min, l.force_max),
                               std::clamp(right, l.force_min, l.force_max)};
    clipped = f.left != left || f.right != right;
    return f;
  }

  AllocationLimits<double> l;
  double stop_rad = 0.0;
  bool clipped = false;
};

/// Tolerance: 60 bisections end within 1e-16 rad; the rounding of the operands of tau_turn/(l_f
/// tau_speed), 2e-16, is amplified to at most 1e-13 within the stop.
TEST(Allocation, IsTheSolutionOfEquation41InEveryModeAndAtEveryLimit) {
  EXPECT_TRUE(rc::check([] {
    AllocationLimits<double> l =
        limits(*rc::gen::element(CombinedSplit::kFixedHalf, CombinedSplit::kRedistribute));
    l.force_min = *rc::gen::element(-1.0, -0.3, 0.0);
    const double tau_speed = drawn(-5.0, 5.0) * *rc::gen::element(1.0, 0.02);
    const double tau_turn_m = drawn(-3.0, 3.0) * *rc::gen::element(1.0, 0.03);
    for (const YawMode mode : kModes) {
      const Allocation<double> expected = Reference41(l)(mode, tau_speed, tau_turn_m);
      const Allocation<double> a = allocate(mode, tau_speed, tau_turn_m, l);
      RC_ASSERT(std::abs(a.steering_rad - expected.steering_rad) < 1e-12);
      RC_ASSERT(std::abs(a.force.left - expected.force.left) < 1e-12);
      RC_ASSERT(std::abs(a.force.right - expected.force.right) < 1e-12);
    }
  }));
}

TEST(Allocation, NanStaysNan) {
  const double nan = std::nan("");
  for (const YawMode mode : kModes) {
    EXPECT_TRUE(std::isnan(allocate(mode, nan, 0.1, limits()).force.left));
    EXPECT_TRUE(std::isnan(allocate(mode, 1.0, nan, limits()).force.right));
  }
}

TEST(Allocation, EachModeUsesItsOwnPath) {
  const Allocation<double> differential = allocate(YawMode::kDifferential, 1.0, 0.05, limits());
  EXPECT_EQ(differential.steering_rad, 0.0);
  EXPECT_DOUBLE_EQ(differential.force.right, 1.0 / 4.0 + 0.05 / (4.0 * 0.36));
  EXPECT_DOUBLE_EQ(differential.force.left, 1.0 / 4.0 - 0.05 / (4.0 * 0.36));
  const Allocation<double> steering = allocate(YawMode::kSteering, 1.0, 0.05, limits());
  EXPECT_EQ(steering.force.left, steering.force.right);
  EXPECT_DOUBLE_EQ(steering.steering_rad, 2.0 * std::atan(0.05 / 0.35));
  const Allocation<double> combined = allocate(YawMode::kCombined, 1.0, 0.05, limits());
  EXPECT_NEAR(delivered(combined).tau_steering_m, 0.025, 1e-15);
  EXPECT_NEAR(delivered(combined).tau_diff_m, 0.025, 1e-15);
}

TEST(Allocation, StaysInsideTheLimitsAndFiniteWhateverIsRequested) {
  const double extremes[] = {0.0, 1e-300, -1e-300, 1e-7, -1e-7, 1.0,   -1.0,
                             4.0, -4.0,   1e6,     -1e6, 1e300, -1e300};
  for (const YawMode mode : kModes) {
    for (const double tau_speed : extremes) {
      for (const double tau_turn_m : extremes) {
        for (const CombinedSplit split :
             {CombinedSplit::kFixedHalf, CombinedSplit::kRedistribute}) {
          const auto l = limits(split);
          const Allocation<double> a = allocate(mode, tau_speed, tau_turn_m, l);
          ASSERT_TRUE(std::abs(a.steering_rad) <= l.steering_max_rad)
              << tau_speed << " " << tau_turn_m;
          ASSERT_TRUE(a.force.left >= -1.0 && a.force.left <= 1.0)
              << tau_speed << " " << tau_turn_m;
          ASSERT_TRUE(a.force.right >= -1.0 && a.force.right <= 1.0)
              << tau_speed << " " << tau_turn_m;
        }
      }
    }
  }
}

TEST(Allocation, ReportsSteeringWithoutAuthority) {
  for (const double tau_speed : {0.0, -0.5, 1e-9}) {
    EXPECT_TRUE(allocate(YawMode::kSteering, tau_speed, 0.1, limits()).steering_powerless);
    const Allocation<double> combined = allocate(YawMode::kCombined, tau_speed, 0.1, limits());
    EXPECT_TRUE(combined.steering_powerless);
    EXPECT_NEAR(moment(combined), 0.1, 1e-15);  // entirely by the forces
  }
  EXPECT_FALSE(allocate(YawMode::kSteering, 0.5, 0.1, limits()).steering_powerless);
}

/// The steering limit is tapered to 0 at tau_speed 0; otherwise the command would jump by 20 deg
/// there.
TEST(Allocation, TheSteeringCommandHasNoJumpWhereThrustCrossesZero) {
  for (const AllocationForm form : {AllocationForm::kExact, AllocationForm::kPaper}) {
    for (const bool is_rear_driven : {true, false}) {
      for (const YawMode mode : {YawMode::kSteering, YawMode::kCombined}) {
        for (const double tau_turn_m : {0.001, -0.02, 0.3}) {
          AllocationLimits<double> l = limits();
          l.form = form;
          l.is_rear_driven = is_rear_driven;
          const double step = 1e-4;
          double before_rad = 0.0;
          for (double tau_speed = -0.01; tau_speed < 0.2; tau_speed += step) {
            const double now_rad = allocate(mode, tau_speed, tau_turn_m, l).steering_rad;
            // The limit rises by 20 degrees over 1/16 of tau_speed, initially 2 % faster than its
            // mean.
            ASSERT_LE(std::abs(now_rad - before_rad), 1.1 * radians(20.0) * step / 0.0625)
                << "tau_speed " << tau_speed << ", tau_turn " << tau_turn_m;
            before_rad = now_rad;
          }
        }
      }
    }
  }
}

TEST(Allocation, TheSteeringsLimitRisesWithTheThrustAndCombinedMakesUpForIt) {
  const double quarter = 0.25 * 0.5 * std::tan(radians(10.0));
  const Allocation<double> weak = allocate(YawMode::kSteering, 0.015625, 1.0, limits());
  EXPECT_TRUE(weak.steering_limited);
  EXPECT_NEAR(weak.steering_rad, 2.0 * std::atan(2.0 * quarter), 1e-15);
  EXPECT_NEAR(delivered(weak).tau_speed, 0.015625, 1e-15);
  const Allocation<double> both = allocate(YawMode::kCombined, 0.015625, 0.5, limits());
  EXPECT_NEAR(both.steering_rad, 2.0 * std::atan(2.0 * quarter), 1e-15);
  EXPECT_NEAR(moment(both), 0.5, 1e-14);
  EXPECT_NEAR(delivered(both).tau_speed, 0.015625, 1e-14);
}

/// No quotient of the allocation may be subnormal, because an AVR rounds subnormal numbers
/// differently from a host.
TEST(Allocation, OfFloatsSteersByNoSubnormalAngle) {
  const AllocationLimits<float> l = paper_controller_of<float>().limits;
  for (const YawMode mode : {YawMode::kSteering, YawMode::kCombined}) {
    for (int exponent = -149; exponent < 0; ++exponent) {
      for (const float sign : {1.0F, -1.0F}) {
        const float tiny_m = sign * std::ldexp(1.0F, exponent);
        const float angle_rad = allocate(mode, 0.3F, tiny_m, l).steering_rad;
        ASSERT_NE(std::fpclassify(angle_rad), FP_SUBNORMAL) << tiny_m;
        if (exponent > -80) {
          ASSERT_EQ(angle_rad > 0.0F, sign > 0.0F) << tiny_m;
        }
      }
    }
  }
}

TEST(Allocation, ClipsTauSpeedFirstThenSteeringThenForces) {
  const Allocation<double> fast = allocate(YawMode::kSteering, 9.0, 0.0, limits());
  EXPECT_TRUE(fast.speed_limited);
  EXPECT_DOUBLE_EQ(fast.force.left, 1.0);
  // At d_max the forces follow from the clipped angle: F' = tau_speed/(2 (1 + cos d_max)). At the
  // stop, steering makes 0.35 m tan(10 deg) = 0.0617 m. The requested 0.08 m is slightly more, 5 m
  // much more.
  for (const double tau_turn_m : {0.08, 5.0}) {
    const Allocation<double> turning = allocate(YawMode::kSteering, 1.0, tau_turn_m, limits());
    EXPECT_TRUE(turning.steering_limited);
    EXPECT_DOUBLE_EQ(turning.steering_rad, radians(20.0));
    EXPECT_DOUBLE_EQ(turning.force.left, 1.0 / (2.0 * (1.0 + std::cos(radians(20.0)))));
  }
}

TEST(Allocation, RedistributionNeverDeliversLessOfTheMomentThanTheFixedHalf) {
  EXPECT_TRUE(rc::check([] {
    const double tau_speed = drawn(0.05, 4.0);
    const double tau_turn_m = drawn(0.0, 3.0);
    const double fixed = moment(
        allocate(YawMode::kCombined, tau_speed, tau_turn_m, limits(CombinedSplit::kFixedHalf)));
    const double shared = moment(allocate(YawMode::kCombined, tau_speed, tau_turn_m, limits()));
    // The redistributed moment is between that of the fixed split and the requested one.
    RC_ASSERT(shared >= std::min(fixed, tau_turn_m) - 1e-12);
    RC_ASSERT(shared <= std::max(fixed, tau_turn_m) + 1e-12);
  }));
}

TEST(Allocation, SteeringTakesOverTheMomentOfClippedForces) {
  // With tau_speed 3.6 each force is 0.1 below its limit, so the forces cannot make half of the
  // moment. Steering makes the missing moment, to either side.
  for (const double tau_turn_m : {0.3, -0.3}) {
    const Allocation<double> a = allocate(YawMode::kCombined, 3.6, tau_turn_m, limits());
    EXPECT_TRUE(a.force_limited);
    EXPECT_FALSE(a.steering_limited);
    // The moment that steering takes over is computed with 1 + cos d_r of the old steering angle,
    // an error of 0.3 %.
    EXPECT_NEAR(moment(a), tau_turn_m, 5e-3 * std::abs(tau_turn_m));
  }
}

AllocationLimits<double> small_angle_limits(CombinedSplit split = CombinedSplit::kRedistribute) {
  AllocationLimits<double> l = limits(split);
  l.form = AllocationForm::kPaper;
  return l;
}

/// Force and moments by equation (41) with sin d_r = d_r and cos d_r = 1.
GeneralisedForces<double> delivered_for_small_angles(const Allocation<double>& a) {
  const auto l = limits();
  const double sum = a.force.left + a.force.right;
  return {2.0 * sum, l.front_axle_m * sum * a.steering_rad,
          2.0 * l.half_track_m * (a.force.right - a.force.left)};
}

TEST(AllocationForSmallAngles, IsThePapersEquationWithItsMisprintsCorrected) {
  const double tau_speed = 1.2;
  const double tau_turn_m = 0.05;
  const Allocation<double> differential =
      allocate(YawMode::kDifferential, tau_speed, tau_turn_m, small_angle_limits());
  EXPECT_EQ(differential.steering_rad, 0.0);
  EXPECT_DOUBLE_EQ(differential.force.right, tau_speed / 4.0 + tau_turn_m / (4.0 * 0.36));
  const Allocation<double> steering =
      allocate(YawMode::kSteering, tau_speed, tau_turn_m, small_angle_limits());
  EXPECT_DOUBLE_EQ(steering.steering_rad, 2.0 * tau_turn_m / (0.35 * tau_speed));
  EXPECT_DOUBLE_EQ(steering.force.left, tau_speed / 4.0);
  EXPECT_DOUBLE_EQ(steering.force.right, tau_speed / 4.0);
  const Allocation<double> combined =
      allocate(YawMode::kCombined, tau_speed, tau_turn_m, small_angle_limits());
  EXPECT_DOUBLE_EQ(combined.steering_rad, tau_turn_m / (0.35 * tau_speed));
  EXPECT_DOUBLE_EQ(combined.force.right, tau_speed / 4.0 + tau_turn_m / (8.0 * 0.36));
  EXPECT_DOUBLE_EQ(combined.force.left, tau_speed / 4.0 - tau_turn_m / (8.0 * 0.36));
}

TEST(AllocationForSmallAngles, MovesTheRestOfALimitedPathToTheOther) {
  // At its stop of 20 deg, steering makes the moment l_f tau_speed d_max/2; differential forces
  // make the rest.
  const Allocation<double> stopped = allocate(YawMode::kCombined, 1.0, 0.4, small_angle_limits());
  EXPECT_TRUE(stopped.steering_limited);
  EXPECT_DOUBLE_EQ(stopped.steering_rad, radians(20.0));
  const auto tau = delivered_for_small_angles(stopped);
  EXPECT_NEAR(tau.tau_steering_m, 0.35 * 0.5 * radians(20.0), 1e-15);
  EXPECT_NEAR(tau.tau_steering_m + tau.tau_diff_m, 0.4, 1e-15);
  // With tau_speed 3.9 each force is 0.025 below its limit: steering makes the missing moment.
  const Allocation<double> forced = allocate(YawMode::kCombined, 3.9, 0.2, small_angle_limits());
  EXPECT_TRUE(forced.force_limited);
  const auto left = delivered_for_small_angles(forced);
  // Clipping the forces also changed tau_speed; the steering angle compensates for that.
  EXPECT_NEAR(left.tau_steering_m + left.tau_diff_m, 0.2, 1e-12);
}

TEST(AllocationForSmallAngles, StaysInsideTheLimitsWhateverIsRequested) {
  for (const YawMode mode : kModes) {
    for (const double tau_speed : {0.0, 1e-300, -1e-7, 1.0, -4.0, 1e6, 1e300}) {
      for (const double tau_turn_m : {0.0, -1e-300, 1e-7, -1.0, 4.0, -1e6, 1e300}) {
        for (const CombinedSplit split :
             {CombinedSplit::kFixedHalf, CombinedSplit::kRedistribute}) {
          const auto l = small_angle_limits(split);
          const Allocation<double> a = allocate(mode, tau_speed, tau_turn_m, l);
          ASSERT_LE(std::abs(a.steering_rad), l.steering_max_rad);
          ASSERT_TRUE(std::abs(a.force.left) <= 1.0 && std::abs(a.force.right) <= 1.0);
        }
      }
    }
  }
}

TEST(Allocation, FloatIsClippedAsEveryScalarIs) {
  struct Range {
    float lo, hi;
  };
  // Ranges of reversible forces, of forces that only drive forward, of forces that never reach 0,
  // and of negative forces.
  for (const Range range : {Range{-1.0F, 1.0F}, Range{-0.25F, 1.0F}, Range{-1.0F, 0.25F},
                            Range{0.0F, 1.0F}, Range{0.1F, 1.0F}, Range{-1.0F, -0.1F}}) {
    for (const float x : {0.0F, -0.0F, 0.05F, -0.05F, 0.1F, -0.1F, 0.25F, -0.25F, 0.5F, -0.5F, 1.0F,
                          -1.0F, 2.0F, -2.0F, HUGE_VALF, -HUGE_VALF}) {
      const double expected = math::clamp(static_cast<double>(x), static_cast<double>(range.lo),
                                          static_cast<double>(range.hi));
      const float clamped = math::clamp(x, range.lo, range.hi);
      EXPECT_EQ(static_cast<double>(clamped), expected)
          << x << " in [" << range.lo << ", " << range.hi << "]";
      EXPECT_EQ(math::is_different(clamped, x),
                math::is_different<double>(expected, static_cast<double>(x)))
          << x;
    }
    const float nan = math::clamp(std::nanf(""), range.lo, range.hi);
    EXPECT_TRUE(std::isnan(nan));
  }
}

/// Inside the limits, motors with back-EMF make exactly the allocated forces at the speeds of their
/// wheels.
TEST(Allocation, MotorsWithBackEmfMakeTheForcesOfTheAllocation) {
  EXPECT_TRUE(rc::check([] {
    AllocationLimits<double> l = limits();
    l.back_emf_s_per_m = 0.3;
    const double u = drawn(-1.5, 1.5);
    const double r = drawn(-0.5, 0.5);
    const Allocation<double> a = allocate(YawMode::kDifferential, drawn(-9, 9), drawn(-1, 1), l, u);
    RC_ASSERT(a.force.left >= l.force_min - 0.3 * u - 1e-15);
    RC_ASSERT(a.force.right <= l.force_max - 0.3 * u + 1e-15);
    const SideForces<double> c = motor_commands(a.force, prepared(l), 0.0, 0.3, u, r);
    RC_ASSERT(c.left >= l.force_min && c.left <= l.force_max);
    RC_ASSERT(c.right >= l.force_min && c.right <= l.force_max);
    const bool inside = c.left > l.force_min && c.left < l.force_max;
    const double made = c.left - 0.3 * (u - l.half_track_m * r);
    RC_ASSERT(!inside || std::abs(made - a.force.left) < 1e-14);
  }));
}

TEST(Allocation, AssumesRestWithoutASpeed) {
  AllocationLimits<double> l = limits();
  l.back_emf_s_per_m = 0.3;
  const Allocation<double> unsaid = allocate(YawMode::kCombined, 3.9, 0.1, l);
  const Allocation<double> at_rest = allocate(YawMode::kCombined, 3.9, 0.1, l, 0.0);
  EXPECT_EQ(unsaid.force.left, at_rest.force.left);
  EXPECT_NE(unsaid.force.left, allocate(YawMode::kCombined, 3.9, 0.1, l, 1.0).force.left);
}

AllocationLimits<double> front_limits() {
  AllocationLimits<double> l = limits();
  l.is_rear_driven = false;
  return l;
}

GeneralisedForces<double> by_front_wheels(const Allocation<double>& a) {
  const auto l = front_limits();
  return front_wheel_forces(l.front_axle_m, l.half_track_m, a.force, a.steering_rad);
}

TEST(FrontWheelAllocation, DeliversExactlyWhatIsRequestedInsideTheLimits) {
  EXPECT_TRUE(rc::check([] {
    const double tau_speed = drawn(0.1, 1.5);
    // |d_r| < 20 deg needs |tau_turn| < l_f tau_speed tan(20 deg) = 0.13 tau_speed. The test uses
    // at most half of this moment. The forces are then at most (1.5 + 0.19/0.36)/(2 cos 20 deg) =
    // 1.08 in differential mode, within the limits.
    const double tau_turn_m = drawn(-1, 1) * 0.5 * 0.35 * tau_speed * std::tan(radians(20.0));
    for (const YawMode mode : kModes) {
      const Allocation<double> a = allocate(mode, tau_speed, tau_turn_m, front_limits());
      RC_ASSERT(!a.speed_limited && !a.steering_limited && !a.force_limited &&
                !a.steering_powerless);
      const GeneralisedForces<double> tau = by_front_wheels(a);
      RC_ASSERT(std::abs(tau.tau_speed - tau_speed) < 1e-14);
      RC_ASSERT(std::abs(tau.tau_steering_m + tau.tau_diff_m - tau_turn_m) < 1e-14);
    }
  }));
}

TEST(FrontWheelAllocation, StaysInsideTheLimitsAndRedistributes) {
  EXPECT_TRUE(rc::check([] {
    const AllocationLimits<double> l = front_limits();
    const double tau_speed = drawn(-3, 3);
    const double tau_turn_m = drawn(-2, 2);
    for (const YawMode mode : kModes) {
      const Allocation<double> a = allocate(mode, tau_speed, tau_turn_m, l);
      RC_ASSERT(a.force.left >= l.force_min && a.force.left <= l.force_max);
      RC_ASSERT(a.force.right >= l.force_min && a.force.right <= l.force_max);
      RC_ASSERT(std::abs(a.steering_rad) <= l.steering_max_rad);
      RC_ASSERT(a.speed_limited == (std::abs(tau_speed) > 2.0));
    }
    // At the stop, differential force provides the rest of the moment.
    const Allocation<double> a = allocate(YawMode::kCombined, 0.5, 0.4 * drawn(-1, 1), l);
    const GeneralisedForces<double> tau = by_front_wheels(a);
    RC_ASSERT(a.force_limited || std::abs(tau.tau_speed - 0.5) < 1e-14);
  }));
  const Allocation<double> a = allocate(YawMode::kCombined, 0.5, 0.3, front_limits());
  ASSERT_TRUE(a.steering_limited && !a.force_limited);
  const GeneralisedForces<double> tau = by_front_wheels(a);
  EXPECT_NEAR(tau.tau_steering_m + tau.tau_diff_m, 0.3, 1e-14);
}

/// The small-angle form approximates the exact one: its error is quadratic in the angles.
TEST(FrontWheelAllocation, OfThePaperIsTheExactOneForSmallAngles) {
  AllocationLimits<double> small = front_limits();
  small.form = AllocationForm::kPaper;
  for (const YawMode mode : kModes) {
    const Allocation<double> exact = allocate(mode, 1.0, 0.001, front_limits());
    const Allocation<double> paper = allocate(mode, 1.0, 0.001, small);
    EXPECT_NEAR(paper.steering_rad, exact.steering_rad, 1e-8);
    EXPECT_NEAR(paper.force.left, exact.force.left, 1e-5);
    EXPECT_NEAR(paper.force.right, exact.force.right, 1e-5);
  }
}

}  // namespace
}  // namespace awmr::testing
