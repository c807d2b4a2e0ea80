/// Stops and starts with a resistance whose slope at rest is infinite.
#include <gtest/gtest.h>

#include <cmath>

#include "simulate/paper_plant.h"

namespace awmr::testing {
namespace {

TEST(Rest, MotorsOffEverySpeedFallsToZeroWithoutChangingSign) {
  for (const double beta : {0.0, 0.3, 0.8, 0.95, 1.0, 2.0}) {
    Plant<double> plant = paper_plant();
    plant.surge.beta = plant.yaw.beta = beta;
    State<double> start{};
    start.u_mps = 1.0;
    start.r_radps = 0.5;
    start.v_mps = -0.2;
    const awmr::Run run = run_open_loop(plant, start, 20.0, {});
    for (std::size_t i = 1; i < run.rows.size(); ++i) {
      const State<double>& s = run.rows[i].state;
      ASSERT_TRUE(std::isfinite(s.x_m) && std::isfinite(s.y_m) && std::isfinite(s.psi_rad));
      ASSERT_GE(s.r_radps, 0.0) << "beta " << beta << " row " << i;
      ASSERT_LE(s.r_radps, run.rows[i - 1].state.r_radps) << "beta " << beta << " row " << i;
    }
    // With an exponent below 1 the stop takes a finite time. Below 1e-3 rad/s the resistance is
    // replaced by a straight line through the origin (the chord). Motion there decays faster than
    // 1/h and ends at 0.
    if (beta < 1.0) {
      EXPECT_EQ(run.rows.back().state.r_radps, 0.0) << beta;
      EXPECT_EQ(run.rows.back().state.u_mps, 0.0) << beta;
    }
  }
}

TEST(Rest, CoastDownFollowsItsClosedForm) {
  // u^(1-b) = u0^(1-b) - (1-b) a t/m'                                             [paper (57)-(59)]
  const Plant<double> plant = paper_plant();
  State<double> start{};
  start.u_mps = 1.66;
  const double k = 1.0 - plant.surge.beta;
  const double stop_s = plant.mass_norm * std::pow(1.66, k) / (k * plant.surge.alpha);
  const awmr::Run run = run_open_loop(plant, start, 1.0, {});
  for (const RunRow& row : run.rows) {
    const double left = std::pow(1.66, k) - k * plant.surge.alpha * row.t_s / plant.mass_norm;
    const double expected = row.t_s < stop_s ? std::pow(left, 1.0 / k) : 0.0;
    // Tolerance: the error of RK4 with h = 1 ms. The time constant is m' u^k/(a b) > 20 ms for u >
    // 1e-4 m/s.
    EXPECT_NEAR(row.state.u_mps, expected, 1e-7) << row.t_s;
  }
}

TEST(Rest, SteadyYawRateOfAStronglyDampedVehicleIsTheLawsOwn) {
  // The steady yaw rate, a3 r^b3 = tau_turn, is above the range in which g3 is replaced by a chord.
  // The integration step must therefore be short enough for the steep g3 at this rate.
  Plant<double> plant = paper_plant();
  plant.yaw = {0.9, 0.3};
  const awmr::Run run = run_open_loop(plant, {}, 5.0, {0.5, 0.2});
  const double expected = std::pow(0.2 / 0.9, 1.0 / 0.3);
  ASSERT_GT(expected, 1e-3);
  EXPECT_NEAR(run.rows.back().state.r_radps, expected, 1e-9);
}

TEST(Rest, WorkOfTheMotorsIsKineticEnergyPlusDissipation) {
  // Energy balance, checked by the trapezoidal rule:
  // d/dt (m' u^2/2 + m' v^2/2 + I'z r^2/2) = tau_speed u + (tau_steer/l_f) v + tau_turn r
  //                                          - g1(u) u - g2(v) v - g3(r) r
  const Plant<double> plant = paper_plant();
  const awmr::Run run = run_open_loop(plant, {}, 5.0, {1.2, 0.05}, YawMode::kCombined);
  const auto power = [&](const RunRow& row) {
    const State<double>& s = row.state;
    const auto tau =
        generalised_forces(plant.front_axle_m, plant.half_track_m, row.force, s.steering_rad);
    return tau.tau_speed * s.u_mps + tau.tau_steering_m / plant.front_axle_m * s.v_mps +
           (tau.tau_steering_m + tau.tau_diff_m) * s.r_radps - plant.surge(s.u_mps) * s.u_mps -
           plant.sway_alpha * s.v_mps * s.v_mps - plant.yaw(s.r_radps) * s.r_radps;
  };
  const auto energy = [&](const State<double>& s) {
    return 0.5 * (plant.mass_norm * (s.u_mps * s.u_mps + s.v_mps * s.v_mps) +
                  plant.inertia_norm * s.r_radps * s.r_radps);
  };
  double work = 0.0;
  // The sum begins at 0.1 s, after the kink in the servo's motion. The error of the trapezoidal
  // rule is h^2/12 times the change of the power's slope, about 1e-5 here.
  for (std::size_t i = 10; i + 1 < run.rows.size(); ++i) {
    work += 0.005 * (power(run.rows[i]) + power(run.rows[i + 1]));
  }
  EXPECT_NEAR(work, energy(run.rows.back().state) - energy(run.rows[10].state), 1e-4);
}

TEST(Simulate, RowsAreAtWholeSamplesFromZeroToTheDuration) {
  const awmr::Run run = run_open_loop(paper_plant(), {}, 1.0, {1.0, 0.0});
  ASSERT_EQ(run.rows.size(), 101u);
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    EXPECT_EQ(run.rows[i].t_s, static_cast<double>(i) * 0.01);
  }
}

TEST(Simulate, TheCommandOfARowHoldsUntilTheNext) {
  // From rest with a constant tau_speed, the speed at the end of the first sample depends only on
  // the command of the first row.
  const awmr::Run run = run_open_loop(paper_plant(), {}, 0.02, {2.0, 0.0});
  EXPECT_EQ(run.rows[0].force.left, 0.5);
  EXPECT_EQ(run.rows[0].state.u_mps, 0.0);
  EXPECT_GT(run.rows[1].state.u_mps, 0.0);
}

}  // namespace
}  // namespace awmr::testing
