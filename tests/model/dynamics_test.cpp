/// Equations of motion: values by hand, symmetry, and agreement of the form with wheel forces and
/// the form with generalised forces.
#include "awmr/model/dynamics.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

/// Draws a double in [lo, hi]. It is derived from an integer, so that RapidCheck can shrink it.
double drawn(double lo, double hi) {
  return lo + (hi - lo) * *rc::gen::inRange(0, 10001) / 10000.0;
}

State<double> drawn_state() {
  return {drawn(-9, 9), drawn(-9, 9), drawn(-7, 7),      drawn(-2, 2),
          drawn(-1, 1), drawn(-3, 3), drawn(-0.35, 0.35)};
}

/// Tolerance for the rounding of sums of terms up to about 1e3: 1e3 * 2^-52 * ten operations.
void expect_same(const State<double>& a, const State<double>& b) {
  constexpr double kRounding = 3e-12;
  RC_ASSERT(std::abs(a.x_m - b.x_m) < kRounding);
  RC_ASSERT(std::abs(a.y_m - b.y_m) < kRounding);
  RC_ASSERT(std::abs(a.psi_rad - b.psi_rad) < kRounding);
  RC_ASSERT(std::abs(a.u_mps - b.u_mps) < kRounding);
  RC_ASSERT(std::abs(a.v_mps - b.v_mps) < kRounding);
  RC_ASSERT(std::abs(a.r_radps - b.r_radps) < kRounding);
  RC_ASSERT(std::abs(a.steering_rad - b.steering_rad) < kRounding);
}

TEST(Dynamics, FourWheelFormEqualsTheReducedFormForEqualForcesOfASide) {
  EXPECT_TRUE(rc::check([] {
    const Plant<double> plant = paper_plant_of<double>();
    const State<double> s = drawn_state();
    const SideForces<double> f{drawn(-1, 1), drawn(-1, 1)};
    const double command = drawn(-0.5, 0.5);
    expect_same(
        state_rates(plant, s, f, command),
        state_rates(plant, s, WheelForces<double>{f.left, f.right, f.left, f.right}, command));
  }));
}

TEST(Dynamics, MirroredVehicleMovesAsTheMirrorImage) {
  EXPECT_TRUE(rc::check([] {
    const Plant<double> plant = paper_plant_of<double>();
    const State<double> s = drawn_state();
    const WheelForces<double> f{drawn(-1, 1), drawn(-1, 1), drawn(-1, 1), drawn(-1, 1)};
    const double command = drawn(-0.5, 0.5);
    const auto mirrored = [](const State<double>& a) {
      return State<double>{a.x_m,    -a.y_m,     -a.psi_rad,     a.u_mps,
                           -a.v_mps, -a.r_radps, -a.steering_rad};
    };
    expect_same(
        mirrored(state_rates(plant, s, f, command)),
        state_rates(plant, mirrored(s),
                    WheelForces<double>{f.front_right, f.front_left, f.rear_right, f.rear_left},
                    -command));
  }));
}

TEST(Dynamics, DoNotDependOnPositionAndHeading) {
  EXPECT_TRUE(rc::check([] {
    const Plant<double> plant = paper_plant_of<double>();
    const State<double> s = drawn_state();
    State<double> moved = s;
    moved.x_m += 5.0;
    moved.y_m -= 3.0;
    const double turn = drawn(-3, 3);
    moved.psi_rad += turn;
    const SideForces<double> f{drawn(-1, 1), drawn(-1, 1)};
    State<double> expected = state_rates(plant, s, f, 0.1);
    const double x_rate = expected.x_m;
    expected.x_m = std::cos(turn) * x_rate - std::sin(turn) * expected.y_m;
    expected.y_m = std::sin(turn) * x_rate + std::cos(turn) * expected.y_m;
    expect_same(state_rates(plant, moved, f, 0.1), expected);
  }));
}

TEST(Dynamics, EachEquationBySubstitution) {
  const Plant<double> p = paper_plant_of<double>();
  const State<double> s{1.0, 2.0, 0.5, 1.2, 0.1, 0.4, 0.2};
  const WheelForces<double> f{0.3, 0.5, 0.2, 0.6};
  const State<double> d = state_rates(p, s, f, 0.25);
  const double sin_d = std::sin(0.2);
  const double cos_d = std::cos(0.2);
  EXPECT_DOUBLE_EQ(d.x_m, 1.2 * std::cos(0.5) - 0.1 * std::sin(0.5));
  EXPECT_DOUBLE_EQ(d.y_m, 1.2 * std::sin(0.5) + 0.1 * std::cos(0.5));
  EXPECT_DOUBLE_EQ(d.psi_rad, 0.4);
  // m' u_dot - m' r v = S_f cos d_r + S_r - g1(u), and so on: the equations of motion, multiplied
  // by m' or I'z.
  EXPECT_NEAR(0.0768 * (d.u_mps - 0.4 * 0.1), 0.8 * cos_d + 0.8 - 1.3157 * std::pow(1.2, 0.8841),
              1e-14);
  EXPECT_NEAR(0.0768 * (d.v_mps + 0.4 * 1.2), 0.8 * sin_d - 3.0 * 0.1, 1e-14);
  EXPECT_NEAR(0.01212 * d.r_radps,
              0.35 * 0.8 * sin_d + 0.36 * cos_d * 0.2 + 0.36 * 0.4 - 0.3028 * std::pow(0.4, 0.825),
              1e-14);
  EXPECT_DOUBLE_EQ(d.steering_rad, (0.25 - 0.2) / 0.02);
}

TEST(Dynamics, FrontWheelsTurnTheVehicleByTheirLateralForce) {
  // Two wheels act 0.4 m ahead of the centre of gravity, each with the sideways force 0.3 sin 30
  // deg.
  EXPECT_DOUBLE_EQ(steering_moment_m(0.4, 0.3, pi<double>() / 6.0), 0.12);
}

TEST(Servo, SaturatesTheTargetAndTheRate) {
  const Plant<double> p = paper_plant_of<double>();
  EXPECT_DOUBLE_EQ(steering_rate(p, p.steering_max_rad, 2.0), 0.0);
  EXPECT_DOUBLE_EQ(steering_rate(p, 0.0, 2.0), p.steering_max_rate_radps);
  EXPECT_DOUBLE_EQ(steering_rate(p, 0.0, -2.0), -p.steering_max_rate_radps);
  EXPECT_DOUBLE_EQ(steering_rate(p, 0.01, 0.03), 1.0);
}

TEST(Resistance, IsOddZeroAtRestAndLinearBelowItsChord) {
  const Resistance<double> exact{2.0, 0.5};
  EXPECT_EQ(exact(0.0), 0.0);
  EXPECT_DOUBLE_EQ(exact(4.0), 4.0);
  EXPECT_DOUBLE_EQ(exact(-4.0), -4.0);
  const Resistance<double> chord{2.0, 0.5, 0.01};
  EXPECT_DOUBLE_EQ(chord(0.01), exact(0.01));
  EXPECT_DOUBLE_EQ(chord(0.005), exact(0.01) / 2.0);
  EXPECT_DOUBLE_EQ(chord(-0.005), -exact(0.01) / 2.0);
}

Plant<double> with_back_emf() {
  Plant<double> plant = paper_plant_of<double>();
  plant.back_emf_s_per_m = 0.3;
  return plant;
}

TEST(Resistance, IsFedForwardWithAChordIfItJumpsAtRest) {
  Resistance<double> law = paper_plant().surge;
  EXPECT_EQ(feed_forward(law).rest_speed, law.rest_speed);
  law.coulomb = 0.05;
  EXPECT_EQ(feed_forward(law, 0.3).rest_speed, 0.3);
  law = feed_forward(law);
  EXPECT_EQ(law.rest_speed, 0.02);
  EXPECT_DOUBLE_EQ(law(0.01), 0.5 * law(0.02));
}

/// Equation of motion straight ahead: m' du/dt = 4 (F' - k_e u) - g1(u).
TEST(BackEmf, ReducesEveryMotorsForceWithTheSpeed) {
  const Plant<double> plant = with_back_emf();
  State<double> s{};
  s.u_mps = 0.8;
  const State<double> d = state_rates(plant, s, SideForces<double>{0.5, 0.5}, 0.0);
  EXPECT_NEAR(d.u_mps, (4.0 * (0.5 - 0.3 * 0.8) - plant.surge(0.8)) / plant.mass_norm, 1e-13);
  // If the vehicle drives backwards under a forward command, back-EMF adds to the force.
  s.u_mps = -0.8;
  const State<double> back = state_rates(plant, s, SideForces<double>{0.5, 0.5}, 0.0);
  EXPECT_NEAR(back.u_mps, (4.0 * (0.5 + 0.3 * 0.8) + plant.surge(0.8)) / plant.mass_norm, 1e-13);
}

TEST(BackEmf, IsZeroForMotorsThatAreOff) {
  EXPECT_TRUE(rc::check([] {
    const State<double> s = drawn_state();
    const SideForces<double> off{0.0, 0.0};
    expect_same(state_rates(with_back_emf(), s, off, 0.1),
                state_rates(paper_plant_of<double>(), s, off, 0.1));
    Plant<double> zone = with_back_emf();
    zone.wheel_dead_zone = 0.1;
    Plant<double> ideal = zone;
    ideal.back_emf_s_per_m = 0.0;
    const SideForces<double> within{0.09, -0.1};
    expect_same(state_rates(zone, s, within, 0.1), state_rates(ideal, s, within, 0.1));
  }));
}

/// A wheel force acts along the rolling direction. Back-EMF therefore reduces the power of the
/// motion, m' u u_dot + m' v v_dot + I'z r r_dot, by k_e w^2 for each wheel with the rolling speed
/// w.
TEST(BackEmf, BrakesEveryWheelByItsPower) {
  EXPECT_TRUE(rc::check([] {
    const Plant<double> plant = with_back_emf();
    const State<double> s = drawn_state();
    const WheelForces<double> f{drawn(0.01, 1), drawn(-1, -0.01), drawn(0.01, 1), drawn(-1, -0.01)};
    const auto power = [&](const Plant<double>& p) {
      const State<double> d = state_rates(p, s, f, 0.1);
      return p.mass_norm * (s.u_mps * d.u_mps + s.v_mps * d.v_mps) +
             p.inertia_norm * s.r_radps * d.r_radps;
    };
    const WheelSpeeds<double> w = wheel_speeds(plant.front_axle_m, plant.half_track_m, s);
    const double lost = 0.3 * (w.front_left * w.front_left + w.front_right * w.front_right +
                               w.rear_left * w.rear_left + w.rear_right * w.rear_right);
    // Tolerance: rounding of a few tens of operations on powers of up to 20.
    RC_ASSERT(std::abs(power(paper_plant_of<double>()) - power(plant) - lost) < 1e-12);
  }));
}

/// Compares two forms of the equations: with wheel forces, the rear ones 0, and with generalised
/// forces.
TEST(FrontWheelDrive, PushesWithTheFrontWheelsAlone) {
  EXPECT_TRUE(rc::check([] {
    const Plant<double> all = paper_plant_of<double>();
    Plant<double> plant = all;
    plant.rear_driven = 0.0;
    const State<double> s = drawn_state();
    const SideForces<double> f{drawn(-1, 1), drawn(-1, 1)};
    const State<double> d = state_rates(plant, s, f, 0.1);
    expect_same(d, state_rates(all, s, WheelForces<double>{f.left, f.right, 0.0, 0.0}, 0.1));
    const GeneralisedForces<double> tau =
        front_wheel_forces(plant.front_axle_m, plant.half_track_m, f, s.steering_rad);
    const State<double> none = state_rates(all, s, SideForces<double>{0.0, 0.0}, 0.1);
    // Tolerance: rounding of ten operations on rates of up to 1e3.
    RC_ASSERT(std::abs(d.u_mps - none.u_mps - tau.tau_speed / all.mass_norm) < 3e-12);
    RC_ASSERT(std::abs(d.r_radps - none.r_radps -
                       (tau.tau_steering_m + tau.tau_diff_m) / all.inertia_norm) < 3e-12);
  }));
}

}  // namespace
}  // namespace awmr::testing
