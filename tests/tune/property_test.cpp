/// For random robots, tune() returns gains that meet their constraints, or an error. Simulated runs
/// with these gains depend neither on the step size nor on the form of the equations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "awmr/simulate/simulate.h"
#include "awmr/tune/constraints.h"
#include "awmr/tune/tune.h"
#include "support/any_robot.h"
#include "tune/paper_model.h"

namespace awmr::testing {
namespace {

Scenario short_scenario() {
  Scenario scenario = default_tuning_scenario(paper_model()).value();
  scenario.duration_s = 4.0;
  scenario.guidance = HeadingSteps{{{0.0, radians(30.0)}, {2.0, radians(-30.0)}}};
  return scenario;
}

TuneOptions few_evaluations() {
  TuneOptions options;
  options.global_evaluations = 20;
  options.local_evaluations = 10;
  options.scenarios = {short_scenario()};
  return options;
}

void is_sound_or_refused(double beyond) {
  const Model model = any_model(beyond);
  const Result<Tuning> tuning = tune(model, few_evaluations());
  if (!tuning) {
    RC_ASSERT(!tuning.error().faults.empty());
    RC_ASSERT(tuning.error().kind != ErrorKind::kFault);
    return;
  }
  RC_ASSERT(std::isfinite(tuning->objective));
  for (const ConstraintReport& c : tuning->constraints) {
    RC_ASSERT(std::isfinite(c.value) && std::isfinite(c.limit));
    RC_ASSERT(!c.required || c.margin >= 0.0);
  }
  const Gains<double>& g = tuning->gains;
  for (const double gain :
       {g.heading.lambda, g.heading.mu, g.heading.epsilon, g.speed.mu, g.speed.epsilon}) {
    RC_ASSERT(std::isfinite(gain) && gain > 0.0);
  }
  const std::string text = gains_text(*tuning, few_evaluations(), {});
  RC_ASSERT(!text.empty());  // throws for a number that is not finite
}

TEST(TuneProperty, InTheBoxGainsAreSoundOrRefused) {
  EXPECT_TRUE(rc::check([] { is_sound_or_refused(1.0); }));
}

TEST(TuneProperty, TenTimesOutsideTheBoxTheSameHolds) {
  EXPECT_TRUE(rc::check([] { is_sound_or_refused(10.0); }));
}

/// Largest difference between two runs: heading, rad, and speed, m/s.
double difference(const awmr::Run& a, const awmr::Run& b) {
  EXPECT_EQ(a.rows.size(), b.rows.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.rows.size(), b.rows.size()); ++i) {
    largest = std::max(largest, std::abs(a.rows[i].state.psi_rad - b.rows[i].state.psi_rad));
    largest = std::max(largest, std::abs(a.rows[i].state.u_mps - b.rows[i].state.u_mps));
  }
  return largest;
}

TEST(TunedGains, DoTheSameAtTenTimesFinerStepsAndWithFourWheels) {
  const Model model = paper_model();
  TuneOptions options = few_evaluations();
  options.global_evaluations = 60;
  const Tuning tuning = tune(model, options).value();
  const Plant<double> plant = model.plant().value();
  const auto controller = make_controller(plant, model.vehicle, tuning.gains);
  const Scenario scenario = short_scenario();
  Scenario four_wheels = scenario;  // a fault without loss of force, which selects the
                                    // wheel-by-wheel equations
  four_wheels.faults = {{.wheels = {Wheel::kFrontLeft}, .window = {}, .share = 1.0}};
  const int steps = substeps_for(plant, {}, 0.01);
  for (const YawMode mode : kYawModes) {
    const awmr::Run run = simulate(plant, controller, scenario, mode, {});
    const awmr::Run finer = simulate(plant, controller, scenario, mode,
                                     {.sample_time_s = 0.01, .substeps = 10 * steps});
    const awmr::Run by_wheel = simulate(plant, controller, four_wheels, mode, {});
    // The step's error is that of tests/peers (1e-5 m in 60 s); the two forms round differently.
    EXPECT_LT(difference(run, finer), 1e-4);
    EXPECT_LT(difference(run, by_wheel), 1e-9);
    const Metrics metrics = metrics_of(finer, scenario, controller);
    EXPECT_EQ(metrics.completed, metrics_of(run, scenario, controller).completed);
    EXPECT_NEAR(*metrics.overshoot_deg, *metrics_of(run, scenario, controller).overshoot_deg, 0.01);
  }
}

}  // namespace
}  // namespace awmr::testing
