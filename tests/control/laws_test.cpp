/// Heading and speed laws, checked by hand calculation.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "awmr/control/control_step.h"
#include "support/paper_vehicle.h"
#include "support/strict_scalar.h"

namespace awmr::testing {
namespace {

TEST(Laws, WrapIsInMinusPiToPiWithPiItself) {
  constexpr double kPi = pi<double>();
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3.0 * kPi + 0.1), -kPi + 0.1, 1e-14);
  EXPECT_NEAR(wrap_angle(-7.0), -7.0 + 2.0 * kPi, 1e-14);
}

TEST(Laws, WrapTakesNoLongerForALargeAngleAndLeavesNaNAsItIs) {
  // Repeated subtraction of 2 pi would take 50 s per run at 1e10 deg, and would not end from 1e17
  // on, where it does not change the number.
  constexpr double kPi = pi<double>();
  for (const double angle : {1.7e8, 1e10, -1e17, 1e300, -1.7e308}) {
    const double wrapped = wrap_angle(angle);
    EXPECT_TRUE(wrapped > -kPi && wrapped <= kPi) << angle;
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12) << angle;
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12) << angle;
  }
  EXPECT_TRUE(std::isnan(wrap_angle(std::nan(""))));
  EXPECT_TRUE(std::isnan(wrap_angle(std::numeric_limits<double>::infinity())));
  EXPECT_TRUE(std::isnan(wrap_angle(std::numeric_limits<float>::quiet_NaN())));
  const Strict strict = wrap_angle(Strict(1e10));
  EXPECT_EQ(strict.value(), wrap_angle(1e10));
}

TEST(Laws, HeadingLawBySubstitution) {
  // S = (0.1 - 0.4) + 3 (0.5 - 0.2) = 0.6 is inside the boundary layer, so the correction is mu
  // S/eps = 50 * 0.6/12 = 2.5.
  const Controller<double> c = paper_controller_of<double>();
  const Measurement<double> m{0.2, 1.0, 0.0, 0.4};
  const Reference<double> ref{0.5, 0.1, 0.7, 1.0, 0.0};
  EXPECT_NEAR(sliding_surface(c.gains.heading.lambda, 0.1 - 0.4, 0.5 - 0.2), 0.6, 1e-15);
  EXPECT_NEAR(heading_law(prepared(c), m, ref),
              0.3028 * std::pow(0.4, 0.825) + 0.01212 * (0.7 + 3.0 * (0.1 - 0.4) + 2.5), 1e-15);
}

TEST(Laws, TheLayersConditionIsOnTheSurfaceNotOnTheError) {
  // The correction depends on S, not on e: e = 3 rad is below eps = 4, but S = 9 is above it, so
  // the correction saturates at mu.
  Controller<double> c = paper_controller_of<double>();
  c.gains.heading.epsilon = 4.0;
  EXPECT_NEAR(heading_law(prepared(c), {0.0, 0.0, 0.0, 0.0}, {3.0, 0.0, 0.0, 0.0, 0.0}),
              0.01212 * 50.0, 1e-15);
}

TEST(Laws, ErrorsAcrossTheCutTakeTheShortWay) {
  const Controller<double> c = paper_controller_of<double>();
  const double right = heading_law(prepared(c), {radians(170.0), 0.0, 0.0, 0.0},
                                   {radians(-170.0), 0.0, 0.0, 0.0, 0.0});
  const double same =
      heading_law(prepared(c), {0.0, 0.0, 0.0, 0.0}, {radians(20.0), 0.0, 0.0, 0.0, 0.0});
  EXPECT_NEAR(right, same, 1e-14);
}

TEST(Laws, SpeedLawBySubstitution) {
  const Controller<double> c = paper_controller_of<double>();
  // The correction is mu_s (u_d - u)/eps_s, with (u_d - u)/eps_s = 0.3/1.2 = 0.25.
  EXPECT_NEAR(speed_law(prepared(c), {0.0, 0.7, 0.05, 0.2}, {0.0, 0.0, 0.0, 1.0, 0.1}),
              1.3157 * std::pow(0.7, 0.8841) - 0.0768 * 0.2 * 0.05 + 0.0768 * (0.1 + 5.0 * 0.25),
              1e-15);
}

TEST(DisturbanceObservers, SeeWhatTheCommandAndTheResistanceLeaveOut) {
  // In a steady turn the momentum does not change, so d = -(tau + m' r v - g1) and -(tau_turn -
  // g3).
  const Observers<double> observers{{3.0, 5.0}, {4.0, 5.0}, true};
  const ObservedMotion<double> motion{
      .momentum = {0.08, 0.01}, .resistance = {0.9, 0.2}, .coupling = 0.15};
  const GeneralisedForces<double> allocated{
      .tau_speed = 0.7, .tau_steering_m = 0.04, .tau_diff_m = 0.03};
  for (const bool anti_windup : {true, false}) {
    Observers<double> reported = observers;
    reported.anti_windup = anti_windup;
    ObserversState<double> state = start_observers(reported, motion.momentum);
    AxisForces<double> seen{};
    for (int i = 0; i < 2000; ++i) {
      seen = estimate(reported, motion, state);
      advance(reported, seen, {1.1, 0.3}, allocated, motion, 0.01, state);
    }
    EXPECT_NEAR(seen.surge, -((anti_windup ? 0.7 : 1.1) + 0.15 - 0.9), 1e-12);
    EXPECT_NEAR(seen.yaw_m, -((anti_windup ? 0.07 : 0.3) - 0.2), 1e-12);
  }
}

TEST(Laws, OnTheModelItselfTheSurfaceDecaysAtItsStatedRate) {
  // r_dot = (tau_turn - g3(r))/I'z with the law's tau_turn gives S_dot = -mu sat(S/eps).
  const Controller<double> c = paper_controller_of<double>();
  const Measurement<double> m{0.2, 1.0, 0.0, 0.4};
  const Reference<double> ref{0.5, 0.1, 0.7, 1.0, 0.0};
  const double r_dot = (heading_law(prepared(c), m, ref) - c.yaw(m.r_radps)) / c.inertia_norm;
  const double s_dot = ref.psi_accel_radps2 - r_dot + 3.0 * (ref.psi_rate_radps - m.r_radps);
  EXPECT_NEAR(s_dot, -50.0 * 0.6 / 12.0, 1e-12);
}

}  // namespace
}  // namespace awmr::testing
