/// Models without turning parameters: straight runs equal those of the full model, and scenarios
/// that turn are refused by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "awmr/core/units.h"
#include "awmr/model/paper_gains.h"
#include "awmr/simulate/simulate.h"
#include "simulate/disturbances.h"
#include "simulate/paper_model_ci.h"

namespace awmr::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr ParameterId kOfTurning[] = {ParameterId::kYawAlpha, ParameterId::kYawBeta,
                                      ParameterId::kSwayAlpha, ParameterId::kInertiaNorm,
                                      ParameterId::kSteeringTimeConstant};

Model straight_model() {
  Model model = model_with_intervals();
  for (const ParameterId id : kOfTurning) model[id] = {};
  return model;
}

Scenario straight_on(Guidance guidance) {
  return {.name = "straight on",
          .duration_s = 8.0,
          .initial = {},
          .speed_mps = 1.0,
          .guidance = std::move(guidance)};
}

WaypointPath through(std::vector<Position<double>> points_m) {
  WaypointPath path;
  path.points_m = std::move(points_m);
  path.acceptance_m = 0.5;
  return path;
}

/// Straight motion with different laws and disturbances.
std::vector<Scenario> straight_scenarios() {
  std::vector<Scenario> scenarios{straight_on(OpenLoop{1.2, 0.0}),
                                  straight_on(HeadingSteps{{{0.0, 0.0}}}),
                                  straight_on(through({{3.0, 0.0}, {6.0, 0.0}})),
                                  straight_on(OpenLoop{1.2, 0.0}), straight_on(OpenLoop{1.2, 0.0})};
  scenarios[1].initial.psi_rad = scenarios[1].initial.u_mps = 0.3;
  std::get<HeadingSteps>(scenarios[1].guidance).steps[0].psi_rad = 0.3;
  scenarios[3].disturbance.surge = {constant(-0.3)};
  // A slope at 180 deg to the path. The sine of pi is 1e-16 in double, which must not count as a
  // turn.
  scenarios[4].disturbance.slope = {{radians(5.0), radians(180.0)}};
  return scenarios;
}

/// Run of `model` with ten RK4 steps per sample, also for a partial model.
awmr::Run run_of(const Model& model, const Scenario& scenario, YawMode mode) {
  return simulate(*model.plant(model.simulated_motion()), *controller_for(model, kPaperGains),
                  scenario, mode, {.sample_time_s = model.vehicle.sample_time_s, .substeps = 10});
}

TEST(StraightRun, IsThatOfTheWholeModel) {
  for (const Scenario& scenario : straight_scenarios()) {
    for (const YawMode mode : kYawModes) {
      ASSERT_TRUE(simulate(straight_model(), kPaperGains, scenario, mode));
      const awmr::Run whole = run_of(model_with_intervals(), scenario, mode);
      const awmr::Run straight = run_of(straight_model(), scenario, mode);
      ASSERT_EQ(whole.rows.size(), straight.rows.size());
      for (std::size_t i = 0; i < whole.rows.size(); ++i) {
        // Unknown values are multiplied by zeros, or by the 1e-16 of the sine of pi.
        EXPECT_NEAR(whole.rows[i].state.u_mps, straight.rows[i].state.u_mps, 1e-12);
        EXPECT_NEAR(whole.rows[i].state.x_m, straight.rows[i].state.x_m, 1e-12);
        EXPECT_NEAR(whole.rows[i].state.y_m, straight.rows[i].state.y_m, 1e-12);
      }
    }
  }
}

TEST(StraightRun, IsRefusedByNameWhereTheScenarioTurns) {
  std::vector<Scenario> turning{
      straight_on(OpenLoop{1.2, 0.1}),    straight_on(HeadingSteps{{{0.0, 0.5}}}),
      straight_on(through({{3.0, 1.0}})), straight_on(OpenLoop{1.2, 0.0}),
      straight_on(OpenLoop{1.2, 0.0}),    straight_on(OpenLoop{1.2, 0.0}),
      straight_on(OpenLoop{1.2, 0.0})};
  turning[3].initial.r_radps = 0.1;
  turning[4].initial.v_mps = 0.1;
  turning[5].disturbance.yaw = {constant(0.01)};
  turning[6].faults = {{{Wheel::kFrontLeft}, {}, 0.5}};
  for (const Scenario& scenario : turning) {
    for (const YawMode mode : kYawModes) {
      const auto run = simulate(straight_model(), kPaperGains, scenario, mode);
      ASSERT_FALSE(run);
      EXPECT_EQ(exit_code(run.error()), 2);
      EXPECT_THAT(to_text(run.error()), HasSubstr("the run turns at"));
      for (const ParameterId id : kOfTurning) {
        EXPECT_THAT(to_text(run.error()), HasSubstr(std::string(info(id).trial)));
      }
    }
  }
}

TEST(StraightRun, NeedsTheSurgeLawAndTheMass) {
  for (const ParameterId id :
       {ParameterId::kSurgeAlpha, ParameterId::kSurgeBeta, ParameterId::kMassNorm}) {
    Model model = straight_model();
    model[id] = {};
    const auto run =
        simulate(model, kPaperGains, straight_on(OpenLoop{1.0, 0.0}), YawMode::kSteering);
    ASSERT_FALSE(run);
    EXPECT_THAT(to_text(run.error()), HasSubstr("no value for " + std::string(info(id).name)));
    EXPECT_THAT(to_text(run.error()), Not(HasSubstr("yaw.alpha")));
  }
}

}  // namespace
}  // namespace awmr::testing
