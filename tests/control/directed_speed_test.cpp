/// Travel direction for a speed without a sign: no force accelerates a vehicle further in the wrong
/// direction. Each run has a vehicle with low resistance, for which the signed law diverges.
#include "awmr/control/directed_speed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "awmr/control/autopilot.h"
#include "awmr/control/speed_law.h"
#include "paper_autopilot.h"

namespace awmr::testing {
namespace {

/// Vehicle on a slope, forward and backward: m' du/dt = tau_speed - g1(u) - slope.
struct Vehicle {
  double mass_norm = 1.0;
  double alpha = 0.2;
  double slope = 0.0;
  double u = 0.0;
  double x = 0.0;

  void move(double tau_speed) {
    for (int i = 0; i < 10; ++i) {
      const double pushed = u + 1e-3 * (tau_speed - slope) / mass_norm;
      const double loss = 1e-3 * alpha * std::abs(pushed) / mass_norm;
      u = pushed - std::copysign(loss, pushed);
      x += 1e-3 * u;
    }
  }
};

/// Complete autopilot for such a vehicle, m' = 1 and g1 = 0.2 u, with |u| as its input.
class RollingVehicle : public PaperAutopilot {
 protected:
  RollingVehicle() {
    Controller<float> controller = paper_controller_of<float>();
    controller.surge.alpha = 0.2F;
    controller.surge.beta = 1.0F;
    controller.mass_norm = 1.0F;
    controller.gains.speed = {3.0F, 1.0F};
    EXPECT_GT(unsigned_push(controller.surge, controller.mass_norm, controller.gains.speed, 0.5F),
              controller.surge(0.5F));
    block_.surge_alpha_beta[0] = 0.2F;
    block_.surge_alpha_beta[1] = 1.0F;
    block_.constants = prepared(controller).constants;
    crc_ = crc32_of_parameters(&block_, nullptr, 0, nullptr, 0);
    start_autopilot(autopilot_, &block_, nullptr, 0, nullptr, 0, crc_);
    in_ = good();
    in_.measured = {0.0F, 0.0F, 0.0F, 0.0F};
    in_.reference = {0.0F, 0.0F, 0.0F, 0.0F, 0.0F};
    in_.speed_unsigned = 1;
  }
  /// Simulates a step of 10 ms. A fix arrives every 200 ms and is `latency` steps old.
  void step(float u_ref_mps, bool is_unsigned = true) {
    const std::uint32_t now_ms = in_.times.now_ms + 10;
    in_.times.now_ms = in_.times.heading_ms = in_.times.command_ms = now_ms;
    if (now_ms % 200 == 0) {
      in_.measured.u_mps =
          static_cast<float>(std::abs(vehicle_.u) + noise_mps_ * std::sin(0.7 * now_ms));
      in_.position_m = {static_cast<float>(vehicle_.x), 0.0F};
      in_.times.speed_ms = now_ms;
    }
    in_.speed_unsigned = is_unsigned ? 1 : 0;
    in_.reference.speed_mps = u_ref_mps;
    autopilot_step(autopilot_, in_, out_);
    EXPECT_EQ(out_.fault, kFaultNone);
    vehicle_.move(std::clamp(static_cast<double>(out_.tau_speed), -4.0, 4.0));
  }

  Autopilot<Resistance<float>, NoParts> autopilot_{};
  AutopilotInput in_{};
  AutopilotOutput out_{};
  Vehicle vehicle_;
  double noise_mps_ = 0.0;
};

TEST_F(RollingVehicle, RunsAwayBackwardWithoutADirection) {
  vehicle_.u = -0.3;
  for (int i = 0; i < 1000 && vehicle_.u > -1.0; ++i) step(0.0F, false);
  EXPECT_LT(vehicle_.u, -0.8) << "with |u| as input, the law must accelerate this vehicle backward";
}

TEST_F(RollingVehicle, ComesToRestFromAnyPush) {
  for (const double push : {-2.0, -0.87, -0.3, 0.3, 0.87, 2.0}) {
    vehicle_.u = push;
    double fastest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      step(0.0F);
      fastest = std::max(fastest, std::abs(vehicle_.u));
    }
    EXPECT_LE(fastest, std::abs(push)) << push;
    EXPECT_LT(std::abs(vehicle_.u), 0.05) << push;
  }
}

TEST_F(RollingVehicle, NoiseAtRestCommandsNothing) {
  noise_mps_ = 0.3;
  for (int i = 0; i < 6000; ++i) {
    step(0.0F);
    ASSERT_EQ(out_.tau_speed, 0.0F);
  }
}

TEST_F(RollingVehicle, BrakesFromADriveAndStaysAtRest) {
  for (const double mass : {0.7, 1.0, 1.4}) {
    vehicle_.mass_norm = mass;
    for (int i = 0; i < 1500; ++i) step(1.0F);
    EXPECT_NEAR(vehicle_.u, 1.0, 0.1) << mass;
    double slowest = 1.0;
    const double from_m = vehicle_.x;
    for (int i = 0; i < 3000; ++i) {
      step(0.0F);
      slowest = std::min(slowest, vehicle_.u);
    }
    // The predicted speed of a lighter vehicle falls too slowly, so the law brakes it for too long
    // and pushes it backward.
    EXPECT_GT(slowest, -0.35) << mass;
    EXPECT_LT(std::abs(vehicle_.u), 0.05) << mass;
    EXPECT_LT(std::abs(vehicle_.x - from_m), 4.0) << mass;
  }
}

TEST_F(RollingVehicle, DrivesBackwardOnCommand) {
  for (int i = 0; i < 1500; ++i) step(-0.5F);
  EXPECT_NEAR(vehicle_.u, -0.5, 0.1);
  for (int i = 0; i < 1500; ++i) step(0.5F);
  EXPECT_NEAR(vehicle_.u, 0.5, 0.1);
}

TEST_F(RollingVehicle, IsNeverPushedFasterDownASlope) {
  vehicle_.slope = 0.3;  // force over F_max, backward
  double slowest = 0.0;
  for (int i = 0; i < 6000; ++i) {
    step(0.0F);
    slowest = std::min(slowest, vehicle_.u);
  }
  EXPECT_GT(slowest, -1.5) << "without braking, the vehicle would reach 0.3/0.2 = 1.5 m/s";
}

TEST(RunsAwayUnsigned, IsTheConditionOfTheLaw) {
  const Resistance<double> g1{.alpha = 1.3, .beta = 1.0};
  // The speed law accelerates a vehicle that rolls backward if m' mu_s/eps_s is above g1(u)/u =
  // 1.3.
  EXPECT_LT(unsigned_push(g1, 1.0, SpeedGains<double>{1.2, 1.0}, 0.5), g1(0.5));
  EXPECT_GT(unsigned_push(g1, 1.0, SpeedGains<double>{1.4, 1.0}, 0.5), g1(0.5));
}

TEST(RunsAwayUnsigned, CountsTheCoulombFrictionThatTheLawFeedsForward) {
  // With c = 0.1, g1(0.5) = 0.75 and the friction fed forward is g1(0.02) = 0.126: the vehicle is
  // accelerated if 0.5 m' mu_s/eps_s is above 0.624.
  const Resistance<double> g1{.alpha = 1.3, .beta = 1.0, .coulomb = 0.1};
  EXPECT_LT(unsigned_push(g1, 1.0, SpeedGains<double>{1.24, 1.0}, 0.5), g1(0.5));
  EXPECT_GT(unsigned_push(g1, 1.0, SpeedGains<double>{1.26, 1.0}, 0.5), g1(0.5));
}

TEST(RunsAwayUnsigned, UsesTheForceOfTheSpeedLaw) {
  for (const double coulomb : {0.0, 0.1}) {
    Controller<double> controller = paper_controller_of<double>();
    controller.surge = {.alpha = 1.3, .beta = 0.7, .coulomb = coulomb};
    controller.gains.speed = {0.8, 0.5};
    const Resistance<double> g1 = controller.surge;
    controller.surge = feed_forward(g1);
    const auto laws = prepared(controller);
    for (const double u_mps : {0.001, 0.015, 0.02, 0.3, 2.0}) {
      EXPECT_DOUBLE_EQ(unsigned_push(g1, controller.mass_norm, controller.gains.speed, u_mps),
                       -speed_law(laws, {0.0, u_mps, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0, 0.0}))
          << coulomb << ' ' << u_mps;
    }
  }
}

}  // namespace
}  // namespace awmr::testing
