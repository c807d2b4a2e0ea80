/// Properties of the tyre law; energy and symmetry of the four-wheel vehicle.
#include "awmr/model/tyres.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/paper_vehicle.h"
#include "support/strict_scalar.h"

namespace awmr::testing {
namespace {

constexpr double kLoad = 0.2;
constexpr Tyres<double> kTyres{.friction = 0.8, .cornering_per_rad = 10.0, .rest_speed_mps = 0.1};

double between(double lo, double hi) {
  return lo + (hi - lo) * *rc::gen::inRange(0, 1000001) / 1e6;
}

State<double> any_state() {
  return {between(-9, 9), between(-9, 9), between(-9, 9),    between(-3, 3),
          between(-3, 3), between(-6, 6), between(-0.6, 0.6)};
}

FourWheels<double> any_vehicle() {
  FourWheels<double> vehicle{paper_plant(), {}};
  vehicle.body.mass_norm = between(0.02, 0.5);
  vehicle.body.inertia_norm = between(0.003, 0.1);
  vehicle.body.front_axle_m = between(0.05, 1.0);
  vehicle.body.half_track_m = between(0.05, 1.0);
  vehicle.body.surge = {between(0.1, 3.0), between(0.3, 1.5)};
  vehicle.tyres = {between(0.05, 1.5), between(2.0, 30.0), between(0.02, 0.5)};
  return vehicle;
}

WheelForces<double> any_forces() {
  return {between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)};
}

TEST(Tyre, GrowsWithASmallSlipByItsCorneringStiffness) {
  // A wheel that rolls at V = sqrt(1 + 0.1^2) has the slip sigma = 1e-6. The next term of F'y,
  // relative to the first, is sigma c_a F'z/(3 mu F'z) = 4e-6.
  constexpr double kSlides_mps = 1e-6;
  const double slip = kSlides_mps / std::hypot(1.0, kTyres.rest_speed_mps);
  for (const double along : {0.0, 0.05, 0.1}) {
    EXPECT_NEAR(side_force(kTyres, kLoad, along, 1.0, kSlides_mps) / slip, -10.0 * kLoad, 2e-5);
  }
}

TEST(Tyre, SaturatesAtTheRemainderOfTheFrictionCircle) {
  const double grip = kTyres.friction * kLoad;
  for (const double share : {0.0, 0.3, 0.6, 0.99, 1.0}) {
    const double left_over = grip * std::sqrt(1.0 - share * share);
    EXPECT_NEAR(side_force(kTyres, kLoad, share * grip, 1.0, 5.0), -left_over, 1e-15) << share;
    EXPECT_NEAR(side_force(kTyres, kLoad, -share * grip, -1.0, -5.0), left_over, 1e-15) << share;
  }
}

/// Pacejka's form of the same law, (3.10): 3 mu F'z theta sigma (1 - theta sigma + (theta
/// sigma)^2/3) with theta = c_a F'z/(3 mu F'z), up to theta sigma = 1.
TEST(Tyre, IsTheCubicOfTheBrushModel) {
  const double grip = kTyres.friction * kLoad;
  for (double share = 0.05; share < 1.0; share += 0.05) {
    const double sigma = share * 3.0 * kTyres.friction / kTyres.cornering_per_rad;
    const double slides_mps = sigma * std::hypot(1.3, kTyres.rest_speed_mps);
    const double expected = 3.0 * grip * share * (1.0 - share + share * share / 3.0);
    EXPECT_NEAR(side_force(kTyres, kLoad, 0.0, 1.3, slides_mps), -expected, 1e-15) << share;
  }
}

TEST(Tyre, HasNoForceAtRestAndIsContinuousThere) {
  EXPECT_EQ(side_force(kTyres, kLoad, 0.0, 0.0, 0.0), 0.0);
  EXPECT_NEAR(side_force(kTyres, kLoad, 0.0, 0.0, 1e-9), 0.0, 3e-8);
  EXPECT_EQ(side_force(kTyres, kLoad, kTyres.friction * kLoad, 0.0, 0.0), 0.0);
}

RC_GTEST_PROP(Tyre, IsOddInWhatItSlidesAndEvenInWhatItRollsAndPasses, ()) {
  const double along = between(-0.16, 0.16);
  const double rolls_mps = between(-2, 2);
  const double slides_mps = between(-2, 2);
  const double force = side_force(kTyres, kLoad, along, rolls_mps, slides_mps);
  RC_ASSERT(side_force(kTyres, kLoad, along, rolls_mps, -slides_mps) == -force);
  RC_ASSERT(side_force(kTyres, kLoad, along, -rolls_mps, slides_mps) == force);
  RC_ASSERT(side_force(kTyres, kLoad, -along, rolls_mps, slides_mps) == force);
}

RC_GTEST_PROP(FourWheels, NoWheelLeavesItsCircleOfFriction, ()) {
  const FourWheels<double> vehicle = any_vehicle();
  const TyreForces<double> made = tyre_forces(vehicle, any_state(), any_forces());
  const double grip = vehicle.tyres.friction * wheel_load(vehicle.body.mass_norm);
  const double x[] = {made.along.front_left, made.along.front_right, made.along.rear_left,
                      made.along.rear_right};
  const double y[] = {made.across.front_left, made.across.front_right, made.across.rear_left,
                      made.across.rear_right};
  for (int i = 0; i < 4; ++i) RC_ASSERT(std::hypot(x[i], y[i]) <= grip * (1.0 + 1e-12));
}

/// The kinetic energy changes by the power of the wheels along their rolling direction minus the
/// lateral tyre losses, which are never negative. With the motors off it only falls.
RC_GTEST_PROP(FourWheels, OnlyDrivesAndTyresChangeTheEnergyAndTyresOnlyReduceIt, ()) {
  const FourWheels<double> vehicle = any_vehicle();
  const Plant<double>& p = vehicle.body;
  const State<double> s = any_state();
  const WheelForces<double> force = any_forces();
  const State<double> d = state_rates(vehicle, s, force, 0.1);
  const double kinetic = p.mass_norm * (s.u_mps * d.u_mps + s.v_mps * d.v_mps) +
                         p.inertia_norm * s.r_radps * d.r_radps;
  const WheelForces<double> x = tyre_forces(vehicle, s, force).along;
  const WheelSpeeds<double> w = wheel_speeds(p.front_axle_m, p.half_track_m, s);
  const double driven = x.front_left * w.front_left + x.front_right * w.front_right +
                        x.rear_left * w.rear_left + x.rear_right * w.rear_right;
  const double taken = tyre_power_mps(vehicle, s, force);
  RC_ASSERT(taken >= 0.0);
  // Tolerance: rounding of some twenty products of up to about 10.
  RC_ASSERT(std::abs(kinetic - (driven - taken)) < 1e-12);
  const State<double> off = state_rates(vehicle, s, SideForces<double>{0.0, 0.0}, 0.1);
  RC_ASSERT(p.mass_norm * (s.u_mps * off.u_mps + s.v_mps * off.v_mps) +
                p.inertia_norm * s.r_radps * off.r_radps <=
            1e-13);
}

RC_GTEST_PROP(FourWheels, MirroredMotionHasMirroredRates, ()) {
  const FourWheels<double> vehicle = any_vehicle();
  const State<double> s = any_state();
  const WheelForces<double> f = any_forces();
  const State<double> a = state_rates(vehicle, s, f, 0.2);
  const State<double> mirrored{s.x_m,    -s.y_m,     -s.psi_rad,     s.u_mps,
                               -s.v_mps, -s.r_radps, -s.steering_rad};
  const State<double> b = state_rates(
      vehicle, mirrored,
      WheelForces<double>{f.front_right, f.front_left, f.rear_right, f.rear_left}, -0.2);
  RC_ASSERT(std::abs(a.u_mps - b.u_mps) <= 1e-11);
  RC_ASSERT(std::abs(a.v_mps + b.v_mps) <= 1e-11);
  RC_ASSERT(std::abs(a.r_radps + b.r_radps) <= 1e-11);
}

/// The integration step is chosen from the tyre rate, so this rate must bound the rates of sway and
/// yaw. For small slip, the coupled system -d(v_dot, r_dot)/d(v, r), scaled to be symmetric, has
/// rates of at most twice the tyre rate, plus the rotation of the velocity.
RC_GTEST_PROP(FourWheels, TheTyreRateBoundsTheRatesOfSwayAndYaw, ()) {
  FourWheels<double> vehicle = any_vehicle();
  vehicle.body.surge.alpha = 0.0;
  const State<double> s = any_state();
  const SideForces<double> none{0.0, 0.0};
  constexpr double h = 1e-7;
  const auto rates = [&](double dv, double dr) {
    State<double> moved = s;
    moved.v_mps += dv;
    moved.r_radps += dr;
    return state_rates(vehicle, moved, none, s.steering_rad);
  };
  // Scaled by sqrt(I'z/m'), so that both speeds are weighted by energy.
  const double scale = std::sqrt(vehicle.body.inertia_norm / vehicle.body.mass_norm);
  const double vv = (rates(h, 0).v_mps - rates(-h, 0).v_mps) / (2 * h);
  const double rr = (rates(0, h).r_radps - rates(0, -h).r_radps) / (2 * h);
  const double vr = (rates(0, h).v_mps - rates(0, -h).v_mps) / (2 * h) / scale;
  const double rv = (rates(h, 0).r_radps - rates(-h, 0).r_radps) / (2 * h) * scale;
  const double norm = std::sqrt(vv * vv + rr * rr + vr * vr + rv * rv);
  // At a slip above 1, the force of a steered or turning wheel also depends on its rolling speed.
  // Friction limits this effect, which at most doubles any rate here.
  RC_ASSERT(norm <= 4.0 * tyre_rate(vehicle, s) + 2.0 * std::abs(s.u_mps) / scale + 1e-3);
}

TEST(FourWheels, StrictScalarGivesTheSameBits) {
  const FourWheels<Strict> strict{paper_plant_of<Strict>(), {}};
  const FourWheels<double> plain{paper_plant(), {}};
  const State<Strict> a =
      state_rates(strict,
                  State<Strict>{Strict(0.0), Strict(0.0), Strict(0.3), Strict(1.2), Strict(0.1),
                                Strict(0.4), Strict(0.2)},
                  SideForces<Strict>{Strict(0.3), Strict(0.5)}, Strict(0.21));
  const State<double> b = state_rates(plain, State<double>{0.0, 0.0, 0.3, 1.2, 0.1, 0.4, 0.2},
                                      SideForces<double>{0.3, 0.5}, 0.21);
  EXPECT_EQ(a.u_mps.value(), b.u_mps);
  EXPECT_EQ(a.v_mps.value(), b.v_mps);
  EXPECT_EQ(a.r_radps.value(), b.r_radps);
}

/// Straight ahead, the vehicle on four tyres accelerates like the model unless the tyres slide, so
/// surge trials cannot distinguish the two.
TEST(FourWheels, DrivesStraightAheadAsTheModelDoes) {
  const Plant<double> plant = paper_plant();
  const State<double> s{0.0, 0.0, 0.0, 1.2, 0.0, 0.0, 0.0};
  for (const double force : {0.3, 0.35, 0.45}) {
    const State<double> model = state_rates(plant, s, SideForces<double>{force, force}, 0.0);
    const State<double> wheels =
        state_rates(FourWheels<double>{plant, {}}, s, SideForces<double>{force, force}, 0.0);
    EXPECT_NEAR(wheels.u_mps, model.u_mps, 1e-12) << force;
    EXPECT_EQ(wheels.v_mps, 0.0);
    EXPECT_EQ(wheels.r_radps, 0.0);
  }
}

}  // namespace
}  // namespace awmr::testing
