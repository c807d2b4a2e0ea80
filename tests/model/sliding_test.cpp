/// Coulomb friction holds, releases and stops a vehicle exactly as calculated.
#include "awmr/model/sliding.h"

#include <gtest/gtest.h>

#include <cmath>

namespace awmr {
namespace {

constexpr double kMass = 0.1;
constexpr double kFriction = 0.2;  // over F_max

/// State after `steps` steps of a vehicle without other forces: u_dot = (force - c sgn u)/m', r_dot
/// = (moment - c3 sgn r)/I'z.
State<double> after(State<double> s, double force, double moment, double h, int steps) {
  constexpr double kInertia = 0.01;
  const FrictionRates<double> friction{kFriction / kMass, 0.005 / kInertia};
  for (int i = 0; i < steps; ++i) {
    s = step_with_friction(friction, s, h, [&](const State<double>&) {
      State<double> rates{};
      rates.u_mps = force / kMass;
      rates.r_radps = moment / kInertia;
      return rates;
    });
  }
  return s;
}

State<double> moving(double u_mps, double r_radps = 0.0) {
  State<double> s{};
  s.u_mps = u_mps;
  s.r_radps = r_radps;
  return s;
}

TEST(Sliding, HoldsAVehicleUnderAForceBelowFriction) {
  for (const double force : {0.0, 0.19, -0.19, 0.2, -0.2}) {
    const State<double> s = after(moving(0.0), force, 0.004, 0.02, 50);
    EXPECT_EQ(s.u_mps, 0.0);
    EXPECT_EQ(s.r_radps, 0.0);
  }
}

TEST(Sliding, ReleasesAVehicleUnderAForceAboveFriction) {
  // Accelerates from rest for 0.3 s by (force - friction)/m' = (0.25 - 0.2)/0.1 m/s^2.
  EXPECT_NEAR(after(moving(0.0), 0.25, 0.0, 0.02, 15).u_mps, 0.15, 1e-14);
  EXPECT_NEAR(after(moving(0.0), -0.25, 0.0, 0.02, 15).u_mps, -0.15, 1e-14);
}

TEST(Sliding, StopsInTheMiddleOfAStepAndStays) {
  // Friction stops 0.11 m/s at 0.2/0.1 = 2 m/s^2 in 0.055 s and then holds the vehicle.
  EXPECT_GT(after(moving(0.11), 0.0, 0.0, 0.02, 2).u_mps, 0.0);
  EXPECT_EQ(after(moving(0.11), 0.0, 0.0, 0.02, 3).u_mps, 0.0);
  EXPECT_EQ(after(moving(-0.11), 0.1, 0.0, 0.02, 30).u_mps, 0.0);
}

TEST(Sliding, ReversesUnderAForceAboveFriction) {
  // Moving backward, it slows down by (0.3 + 0.2)/0.1 m/s^2 for 0.022 s, then accelerates forward
  // by (0.3 - 0.2)/0.1 m/s^2 for the remaining 0.038 s.
  EXPECT_NEAR(after(moving(-0.11), 0.3, 0.0, 0.02, 3).u_mps, 0.038, 1e-14);
}

TEST(Sliding, StopsSurgeAndYawInOneStep) {
  const State<double> s = after(moving(0.01, 0.002), 0.0, 0.0, 0.02, 1);
  EXPECT_EQ(s.u_mps, 0.0);
  EXPECT_EQ(s.r_radps, 0.0);
}

TEST(Sliding, WithoutFrictionIsARungeKuttaStep) {
  const auto rates = [](const State<double>& s) {
    State<double> d{};
    d.u_mps = -3.0 * s.u_mps;
    return d;
  };
  EXPECT_EQ(step_with_friction(FrictionRates<double>{0.0, 0.0}, moving(1.0), 0.1, rates).u_mps,
            rk4_step(moving(1.0), 0.1, rates).u_mps);
}

}  // namespace
}  // namespace awmr
