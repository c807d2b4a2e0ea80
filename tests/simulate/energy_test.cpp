/// Energy: work is kinetic energy plus dissipation; the reduced model equals the four-wheel form.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "awmr/model/rest.h"
#include "awmr/simulate/metrics.h"
#include "awmr/simulate/physics.h"
#include "simulate/energy.h"
#include "simulate/paper_plant.h"
#include "support/any_robot.h"

namespace awmr::testing {
namespace {

Plant<double> plant_near_the_papers() {
  Plant<double> plant = paper_plant();
  plant.surge = {between(0.5, 3.0), between(0.5, 1.5)};
  plant.yaw = {between(0.1, 0.6), between(0.5, 1.5)};
  plant.sway_alpha = between(1.0, 5.0);
  plant.mass_norm = between(0.05, 0.2);
  plant.inertia_norm = between(0.01, 0.05);
  return plant;
}

Scenario any_open_loop() {
  Scenario s{.name = "any",
             .duration_s = 4.0,
             .initial = {},
             .speed_mps = 0.0,
             .guidance = OpenLoop{between(0.3, 2.0), between(-0.3, 0.3)}};
  s.initial.u_mps = between(0.2, 1.5);
  s.initial.v_mps = between(-0.1, 0.1);
  s.initial.r_radps = between(-0.5, 0.5);
  const auto sine = [](double most, double hz) {
    return DisturbanceTerm{.kind = DisturbanceTerm::Kind::kSine,
                           .value = between(-most, most),
                           .window = {},
                           .frequency_hz = hz,
                           .phase_rad = between(0.0, 6.0),
                           .bandwidth_hz = 0.0};
  };
  s.disturbance.surge = {sine(0.3, 0.7)};
  s.disturbance.sway = {sine(0.3, 0.5)};
  s.disturbance.yaw = {sine(0.1, 0.9)};
  return s;
}

/// Input power minus resistance: u X + v Y + r N - u g1 - v g2 - r g3. The terms m' r v u and -m' r
/// u v of surge and sway cancel.
double net_power(const Plant<double>& p, const State<double>& s, const RunRow& row) {
  const GeneralisedForces<double> tau =
      generalised_forces(p.front_axle_m, p.half_track_m, row.force, s.steering_rad);
  const double in = s.u_mps * (tau.tau_speed + row.disturbance.surge) +
                    s.v_mps * (tau.tau_steering_m / p.front_axle_m + row.disturbance.sway) +
                    s.r_radps * (tau.tau_steering_m + tau.tau_diff_m + row.disturbance.yaw_m);
  return in - s.u_mps * p.surge(s.u_mps) - s.v_mps * p.sway_alpha * s.v_mps -
         s.r_radps * p.yaw(s.r_radps);
}

RC_GTEST_PROP(Energy, WorkDoneIsKineticEnergyPlusDissipation, ()) {
  const Plant<double> plant = plant_near_the_papers();
  const Scenario scenario = any_open_loop();
  constexpr double kStep_s = 1e-3;
  const auto controller = make_controller(plant, paper_vehicle(), {});
  const awmr::Run run = simulate(plant, controller, scenario, YawMode::kCombined,
                                 {.sample_time_s = kStep_s, .substeps = 1});
  const Plant<double> resolved = resolved_at_rest(plant, kStep_s);
  double balance = 0.0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    // Command and disturbance of the previous row are constant over the step.
    balance += 0.5 * kStep_s *
               (net_power(resolved, run.rows[i - 1].state, run.rows[i - 1]) +
                net_power(resolved, run.rows[i].state, run.rows[i - 1]));
  }
  const double gained =
      kinetic(plant, run.rows.back().state) - kinetic(plant, run.rows.front().state);
  // The error of the trapezoidal rule is h^2/12 times the change of the power's slope, summed over
  // all transients. With a power of up to 3 m/s and a time constant T >= 0.02 s, a transient adds 3
  // (1e-3/0.02)^2/12 * T = 1e-5 m. Each change of the sign of r adds as much, because a straight
  // line (chord) replaces g3 near rest.
  RC_ASSERT(std::abs(balance - gained) < 2e-4);
}

/// Scenario with a wheel fault that has no effect, which makes the simulator use the four-wheel
/// form.
RC_GTEST_PROP(FourWheels, AgreeWithTheReducedForm, ()) {
  const Plant<double> plant = plant_near_the_papers();
  const Scenario reduced = any_open_loop();
  Scenario four = reduced;
  four.faults = {{.wheels = {Wheel::kFrontLeft}, .window = {}, .share = 1.0}};
  const auto controller = make_controller(plant, paper_vehicle(), {});
  for (const YawMode mode : kYawModes) {
    const State<double> a = simulate(plant, controller, reduced, mode, {}).rows.back().state;
    const State<double> b = simulate(plant, controller, four, mode, {}).rows.back().state;
    // Tolerance: the two forms add terms in different orders, which causes a rounding error of
    // 1e-16 in each of 1e3 steps of a damped system.
    RC_ASSERT(std::abs(a.x_m - b.x_m) < 1e-10);
    RC_ASSERT(std::abs(a.y_m - b.y_m) < 1e-10);
    RC_ASSERT(std::abs(a.psi_rad - b.psi_rad) < 1e-10);
  }
}

/// Scenario of 4 s with F' = 0.5 of each motor.
Scenario driven_straight() {
  return {.name = "driven", .duration_s = 4.0, .initial = {}, .guidance = OpenLoop{2.0, 0.0}};
}

/// Returns the dissipated plus the kinetic energy, which equals the energy of the motors if none
/// brakes.
double taken_and_kept(const Plant<double>& plant, const awmr::Run& run) {
  double taken = 0.0;
  for (std::size_t i = 1; i < run.rows.size(); ++i) {
    for (const std::size_t k : {i - 1, i}) {
      const State<double>& s = run.rows[k].state;
      taken += 0.5 * (run.rows[i].t_s - run.rows[i - 1].t_s) *
               (s.u_mps * plant.surge(s.u_mps) + s.v_mps * plant.sway_alpha * s.v_mps +
                s.r_radps * plant.yaw(s.r_radps));
    }
  }
  return taken + kinetic(plant, run.rows.back().state);
}

TEST(Work, IsThatOfTheForcesThatActWhateverKeepsThemFromTheWheels) {
  const Plant<double> plant = paper_plant();
  const auto controller = make_controller(plant, paper_vehicle(), {});
  Scenario lagging = driven_straight();
  lagging.actuators.emplace().motor_time_constant_s = 0.2;
  Scenario sagging = driven_straight();
  sagging.battery.emplace().sag = 0.2;
  Scenario failing = driven_straight();
  failing.faults.push_back(
      {.wheels = {Wheel::kFrontLeft}, .window = {.from_s = 1.0}, .share = 0.0});
  Scenario empty = driven_straight();
  empty.battery.emplace();
  empty.battery->to_s = 1e-3;
  empty.battery->share_end = 0.3;
  for (const Scenario& scenario : {driven_straight(), lagging, sagging, failing, empty}) {
    const awmr::Run run =
        simulate(plant, controller, scenario, YawMode::kCombined, {.sample_time_s = 1e-3});
    const Metrics metrics = metrics_of(run, scenario, controller);
    // Tolerance: the error of the rectangle rule is half a sample times the change of power, which
    // is at most 2 m/s times 2.
    EXPECT_NEAR(metrics.energy_mech, taken_and_kept(plant, run), 4e-3) << scenario.name;
  }
}

TEST(Work, OfCopperIsThatOfTheMotorsThatRun) {
  const Plant<double> plant = paper_plant();
  const auto controller = make_controller(plant, paper_vehicle(), {});
  const auto copper = [&](const Scenario& scenario) {
    const awmr::Run run =
        simulate(plant, controller, scenario, YawMode::kCombined, {.sample_time_s = 1e-3});
    return metrics_of(run, scenario, controller).energy_electric;
  };
  EXPECT_NEAR(copper(driven_straight()), 4.0 * 4.0 * 0.25, 1e-9);
  Scenario failing = driven_straight();
  failing.faults.push_back(
      {.wheels = {Wheel::kFrontLeft}, .window = {.from_s = 1.0}, .share = 0.0});
  EXPECT_NEAR(copper(failing), 4.0 * 0.25 + 3.0 * 3.0 * 0.25, 1e-3);
  // F'^2 is 0.25 (1 - exp(-t/tau))^2. Its integral over 4 s is 0.25 (4 - 2 tau + tau/2), except for
  // terms of exp(-20).
  Scenario lagging = driven_straight();
  lagging.actuators.emplace().motor_time_constant_s = 0.2;
  EXPECT_NEAR(copper(lagging), 4.0 * 0.25 * (4.0 - 2.0 * 0.2 + 0.1), 1e-4);
}

}  // namespace
}  // namespace awmr::testing
