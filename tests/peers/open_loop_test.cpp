/// The integrator compared with Boost.odeint: the same equations of motion, another method.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "awmr/core/units.h"
#include "awmr/simulate/physics.h"
#include "awmr/simulate/simulate.h"
#include "peers/reference_integrator.h"
#include "support/paper_vehicle.h"

namespace awmr::testing {
namespace {

/// A plant under a constant command.
struct Problem {
  Plant<double> plant;
  SideForces<double> force;
  double steering_command_rad;
  std::optional<Tyres<double>> tyres = {};
};

/// Independent computation of the state rates on four tyres, wheel by wheel: velocity of each
/// contact in world axes, its force by the cubic polynomial of the brush model (Pacejka's form),
/// and moments as cross products.
State<double> rates_wheel_by_wheel(const Problem& problem, const State<double>& s) {
  const Plant<double>& p = problem.plant;
  const Tyres<double>& tyres = *problem.tyres;
  const double load = p.mass_norm * 9.80665 / 4.0;
  double force_x = 0.0, force_y = 0.0, moment = 0.0;
  for (const double ahead : {p.front_axle_m, -p.front_axle_m}) {
    for (const double left : {p.half_track_m, -p.half_track_m}) {
      const double turned = ahead > 0.0 ? s.steering_rad : 0.0;
      const double cos_t = std::cos(turned), sin_t = std::sin(turned);
      const double speed_x = s.u_mps - s.r_radps * left, speed_y = s.v_mps + s.r_radps * ahead;
      const double rolls = speed_x * cos_t + speed_y * sin_t;
      const double slides = speed_y * cos_t - speed_x * sin_t;
      const double motor = left > 0.0 ? problem.force.left : problem.force.right;
      const double grip = tyres.friction * load;
      const double x = std::clamp(motor - p.surge(rolls) / 4.0, -grip, grip);
      const double most = std::sqrt(grip * grip - x * x);
      const double stiffness = tyres.cornering_per_rad * load;
      const double t =
          slides / std::sqrt(rolls * rolls + tyres.rest_speed_mps * tyres.rest_speed_mps);
      const double y =
          stiffness * std::abs(t) >= 3.0 * most
              ? -std::copysign(most, t)
              : -stiffness * t + stiffness * stiffness / (3.0 * most) * std::abs(t) * t -
                    stiffness * stiffness * stiffness / (27.0 * most * most) * t * t * t;
      const double x_body = x * cos_t - y * sin_t, y_body = x * sin_t + y * cos_t;
      force_x += x_body;
      force_y += y_body;
      moment += ahead * y_body - left * x_body;
    }
  }
  return {s.u_mps * std::cos(s.psi_rad) - s.v_mps * std::sin(s.psi_rad),
          s.u_mps * std::sin(s.psi_rad) + s.v_mps * std::cos(s.psi_rad),
          s.r_radps,
          force_x / p.mass_norm + s.r_radps * s.v_mps,
          force_y / p.mass_norm - s.r_radps * s.u_mps,
          moment / p.inertia_norm,
          steering_rate(p, s.steering_rad, problem.steering_command_rad)};
}

/// State at `end_s` with constant forces and steering command.
State<double> reference(const Problem& problem, const State<double>& start, double end_s) {
  const auto rates = [&](const State<double>& s) {
    return problem.tyres
               ? rates_wheel_by_wheel(problem, s)
               : state_rates(problem.plant, s, problem.force, problem.steering_command_rad);
  };
  return integrate_reference(rates, start, end_s);
}

TEST(ReferenceIntegrator, OpenLoopPositionsAgreeAfterAMinuteInEveryMode) {
  const Plant<double> plant = paper_plant();
  Vehicle vehicle{};
  vehicle.wheel_force = {-1.0, 1.0};
  const Controller<double> controller = make_controller(plant, vehicle, {});
  for (const double tau_turn_m : {0.0, 0.05, 0.4}) {
    for (const YawMode mode : kYawModes) {
      const Scenario scenario{"open loop", 60.0, {}, 0.0, OpenLoop{2.0, tau_turn_m}};
      const awmr::Run run = simulate(plant, controller, scenario, mode, {.sample_time_s = 0.01});
      const RunRow& first = run.rows.front();
      const State<double> expected =
          reference({plant, first.force, first.steering_command_rad}, {}, 60.0);
      const State<double>& found = run.rows.back().state;
      EXPECT_NEAR(run.rows.back().t_s, 60.0, 1e-9);
      EXPECT_NEAR(found.x_m, expected.x_m, 1e-5) << name_of(mode) << " " << tau_turn_m;
      EXPECT_NEAR(found.y_m, expected.y_m, 1e-5) << name_of(mode) << " " << tau_turn_m;
    }
  }
}

/// In this test, both the equations and the integrator are independent of the library.
TEST(ReferenceIntegrator, PositionsOnFourTyresAgreeAfterAMinuteInEveryMode) {
  const Plant<double> plant = paper_plant();
  Vehicle vehicle{};
  vehicle.wheel_force = {-1.0, 1.0};
  const Controller<double> controller = make_controller(plant, vehicle, {});
  for (const double friction : {0.3, 0.8}) {
    for (const double tau_turn_m : {0.02, 0.1, 0.4}) {
      for (const YawMode mode : kYawModes) {
        Scenario scenario{"open loop on tyres", 60.0, {}, 0.0, OpenLoop{1.4, tau_turn_m}};
        scenario.tyres = Tyres<double>{.friction = friction};
        const awmr::Run run = simulate(plant, controller, scenario, mode, {.sample_time_s = 0.01});
        const RunRow& first = run.rows.front();
        // The reference also uses the chord that replaces each resistance near rest, because it is
        // part of the equations.
        const Plant<double> resolved = resolved_at_rest(plant, scenario, 0.01 / run.substeps);
        const State<double> expected = reference(
            {resolved, first.force, first.steering_command_rad, scenario.tyres}, {}, 60.0);
        const State<double>& found = run.rows.back().state;
        const std::string where = std::string(name_of(mode)) + ", tau_turn " +
                                  std::to_string(tau_turn_m) + ", friction " +
                                  std::to_string(friction);
        // A tyre force has a kink when its wheel begins or stops spinning or sliding. The position
        // error of a step across the kink is up to the step length, 3.3 ms, times the speed, about
        // 1 m/s.
        EXPECT_NEAR(found.x_m, expected.x_m, 4e-3) << where;
        EXPECT_NEAR(found.y_m, expected.y_m, 4e-3) << where;
        EXPECT_NEAR(found.psi_rad, expected.psi_rad, 2e-5) << where;
        EXPECT_NEAR(found.r_radps, expected.r_radps, 1e-6) << where;
      }
    }
  }
}

TEST(Simulate, ConvergesWithFourthOrderWhereTheModelIsSmooth) {
  Plant<double> plant = paper_plant();
  plant.steering_max_rate_radps = 1e6;  // so high that the rate limit causes no kink
  Vehicle vehicle{};
  vehicle.wheel_force = {-1.0, 1.0};
  const Controller<double> controller = make_controller(plant, vehicle, {});
  State<double> start{};
  start.u_mps = 1.0;
  start.r_radps = 0.3;  // far from 0, where the resistance has a kink
  const Scenario scenario{"smooth", 1.0, start, 0.0, OpenLoop{1.5, 0.2}};
  const auto end = [&](int substeps) {
    return simulate(plant, controller, scenario, YawMode::kCombined,
                    {.sample_time_s = 0.01, .substeps = substeps})
        .rows.back()
        .state;
  };
  const State<double> reference = end(64);
  const auto error = [&](int substeps) {
    const State<double> s = end(substeps);
    return std::hypot(s.x_m - reference.x_m, s.y_m - reference.y_m);
  };
  // Each halving of the step divides the error by 2^4.
  EXPECT_NEAR(std::log2(error(2) / error(4)), 4.0, 0.3);
  EXPECT_NEAR(std::log2(error(4) / error(8)), 4.0, 0.3);
}

}  // namespace
}  // namespace awmr::testing
